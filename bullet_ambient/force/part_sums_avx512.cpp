#define AMBIENT_KERNEL kPartKernelAvx512
#include "bullet_ambient/force/part_sums_kernel.h"
