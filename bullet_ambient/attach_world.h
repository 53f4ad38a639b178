#pragma once

// Fluid::addAll(): a whole world in a fluid.
#include "bullet_ambient/bullet/world/fluid_body_source.h"
#include "bullet_ambient/bullet/world/world_attachment.h"
