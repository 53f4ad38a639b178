#include "bullet_ambient/fluid_body/rejection.h"

#include <sstream>
#include <stdexcept>

namespace ambient {

void reject(const FluidBody& body, const std::string& what, double value, const char* limit) {
  std::ostringstream message;
  message << "fluid body '" << body.name << "': " << what << " is " << value << ", must be "
          << limit;
  throw std::invalid_argument(message.str());
}

}  // namespace ambient
