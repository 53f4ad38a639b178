#define AMBIENT_KERNEL sumFacesAvx512
#include "bullet_ambient/force/face_sums_kernel.h"
