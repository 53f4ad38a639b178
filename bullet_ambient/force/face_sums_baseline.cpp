#define AMBIENT_KERNEL sumFacesBaseline
#include "bullet_ambient/force/face_sums_kernel.h"
