#include "bullet_ambient/motion/flight_kernel.h"

namespace ambient {

const FlightKernel& avx512FlightKernel() noexcept { return kKernel; }

}  // namespace ambient
