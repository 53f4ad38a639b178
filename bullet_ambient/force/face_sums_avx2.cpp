#define AMBIENT_KERNEL sumFacesAvx2
#include "bullet_ambient/force/face_sums_kernel.h"
