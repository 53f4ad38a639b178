#include "bullet_ambient/motion/flight_kernel.h"

namespace ambient {

const FlightKernel kFlightKernelAvx2 = kKernel;

}  // namespace ambient
