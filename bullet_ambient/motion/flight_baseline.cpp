#include "bullet_ambient/motion/flight_kernel.h"

namespace ambient {

const FlightKernel& baselineFlightKernel() noexcept { return kKernel; }

}  // namespace ambient
