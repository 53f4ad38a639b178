#include "bullet_ambient/base/single_precision.h"

namespace ambient {

double roundedToSingle(double value) noexcept {
  return static_cast<double>(static_cast<float>(value));
}

}  // namespace ambient
