#define AMBIENT_KERNEL sumClustersAvx2
#include "bullet_ambient/force/level_sums_kernel.h"
