#include <stdexcept>

#include "preprocess/hand_over/formats.h"

namespace ambient {

ExportedBody makeBemio(const HandedBody& body) {
  throw std::runtime_error("fluid body '" + body.shape->name +
                           "': format bemio needs HDF5, without which this program was built "
                           "(Debian: libhdf5-dev)");
}

}  // namespace ambient
