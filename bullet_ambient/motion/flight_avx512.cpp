#define AMBIENT_KERNEL kFlightKernelAvx512
#include "bullet_ambient/motion/flight_kernel.h"
