#pragma once

// FluidDrawing: what Bullet's debug drawer shows of a fluid.
#include "bullet_ambient/bullet/world/fluid_drawing.h"
