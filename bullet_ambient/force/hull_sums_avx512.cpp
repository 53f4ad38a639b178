#define AMBIENT_KERNEL sumHullAvx512
#include "bullet_ambient/force/hull_sums_kernel.h"
