#define AMBIENT_KERNEL kFlightKernelAvx2
#include "bullet_ambient/motion/flight_kernel.h"
