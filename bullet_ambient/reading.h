#pragma once

// The wrench of the fluid on a body or link by part, Immersed::wrench().
#include "bullet_ambient/bullet/reading/fluid_wrench.h"
