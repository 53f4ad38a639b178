#include "bullet_ambient/motion/flight_kernel.h"

namespace ambient {

const FlightKernel kFlightKernelBaseline = kKernel;

}  // namespace ambient
