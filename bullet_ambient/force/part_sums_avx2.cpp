#define AMBIENT_KERNEL kPartKernelAvx2
#include "bullet_ambient/force/part_sums_kernel.h"
