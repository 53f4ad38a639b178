#pragma once

// Fluid, the fluids of one world, and Immersed, a body or link in one.
#include "bullet_ambient/bullet/world/fluid.h"
#include "bullet_ambient/bullet/world/immersed.h"
#include "bullet_ambient/immersed/attach_def.h"
