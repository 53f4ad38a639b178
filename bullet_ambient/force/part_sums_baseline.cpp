#define AMBIENT_KERNEL kPartKernelBaseline
#include "bullet_ambient/force/part_sums_kernel.h"
