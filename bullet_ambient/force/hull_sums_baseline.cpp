#define AMBIENT_KERNEL kHullKernelBaseline
#include "bullet_ambient/force/hull_sums_kernel.h"
