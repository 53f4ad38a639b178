#define AMBIENT_KERNEL sumBlocksAvx2
#include "bullet_ambient/force/single_sums_kernel.h"
