#define AMBIENT_KERNEL kHullKernelAvx2
#include "bullet_ambient/force/hull_sums_kernel.h"
