#define AMBIENT_KERNEL kHullKernelAvx512
#include "bullet_ambient/force/hull_sums_kernel.h"
