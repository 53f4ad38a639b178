#define AMBIENT_KERNEL sumHullAvx2
#include "bullet_ambient/force/hull_sums_kernel.h"
