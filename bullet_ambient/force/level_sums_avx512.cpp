#define AMBIENT_KERNEL sumClustersAvx512
#include "bullet_ambient/force/level_sums_kernel.h"
