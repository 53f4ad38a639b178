#pragma once

#include <Eigen/Geometry>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Unit quaternion of the rotation vector r [rad]: turns by |r| about r.
Quaternion rotationFromVector(const Vector3& r);

/// Rotation vector of a unit quaternion, of at most half a turn [rad]; accurate for the smallest.
Vector3 rotationVector(const Quaternion& q);

/// Unit quaternion of the smallest rotation that takes the direction of `from` to that of `to`;
/// half a turn about some axis across `from` where they are opposite. Lengths do not matter.
/// @pre neither is zero
Quaternion rotationBetween(const Vector3& from, const Vector3& to);

/// Angle of the rotation that takes one attitude to the other [rad], at most pi.
double angleBetween(const Quaternion& a, const Quaternion& b);

}  // namespace ambient
