#define AMBIENT_KERNEL sumBlocksBaseline
#include "bullet_ambient/force/single_sums_kernel.h"
