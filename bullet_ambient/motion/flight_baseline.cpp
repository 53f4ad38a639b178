#define AMBIENT_KERNEL kFlightKernelBaseline
#include "bullet_ambient/motion/flight_kernel.h"
