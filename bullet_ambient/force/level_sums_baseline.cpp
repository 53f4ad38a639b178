#define AMBIENT_KERNEL sumClustersBaseline
#include "bullet_ambient/force/level_sums_kernel.h"
