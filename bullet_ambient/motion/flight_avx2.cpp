#include "bullet_ambient/motion/flight_kernel.h"

namespace ambient {

const FlightKernel& avx2FlightKernel() noexcept { return kKernel; }

}  // namespace ambient
