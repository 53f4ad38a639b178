#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Unit quaternion of the rotation vector r [rad]: turns by |r| about r.
Quaternion rotationFromVector(const Vector3& r);

/// Rotation vector of a unit quaternion, |r| <= pi [rad]. Accurate for the smallest angles (atan2,
/// no acos).
Vector3 rotationVector(const Quaternion& q);

}  // namespace ambient
