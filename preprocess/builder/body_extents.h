#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Sizes of the bounding box of the body's surface along the axes of F [m]; 0 without a surface.
Vector3 extentsOf(const FluidBody& body);

}  // namespace ambient
