#define AMBIENT_KERNEL sumHullBaseline
#include "bullet_ambient/force/hull_sums_kernel.h"
