#pragma once

#include <Eigen/Geometry>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Unit quaternion of the rotation vector r [rad]: turns by |r| about r.
Quaternion rotationFromVector(const Vector3& r);

/// Rotation vector of a unit quaternion, of at most half a turn [rad]; accurate for the smallest.
Vector3 rotationVector(const Quaternion& q);

}  // namespace ambient
