#include "bullet_ambient/motion/flight_kernel.h"

namespace ambient {

const FlightKernel kFlightKernelAvx512 = kKernel;

}  // namespace ambient
