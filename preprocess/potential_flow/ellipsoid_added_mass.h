#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Added mass of an ellipsoid about its centre, per unit density: diagonal in its axes, rotation
/// first. Semi-axes [m]. Closed form of Lamb, Hydrodynamics, 6th ed., art. 114 and 115, its
/// integrals by Carlson's duplication (1979), to rounding.
/// @pre semi-axes positive and finite
Vector6 ellipsoidAddedMass(const Vector3& semi_axes);

}  // namespace ambient
