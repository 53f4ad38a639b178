#define AMBIENT_KERNEL sumBlocksAvx512
#include "bullet_ambient/force/single_sums_kernel.h"
