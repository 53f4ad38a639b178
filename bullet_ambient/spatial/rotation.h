#pragma once

#include <Eigen/Geometry>

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Unit quaternion of the rotation by the angle |r| about the axis r [rad].
Quaternion rotationFromVector(const Vector3& r);

/// Turns both vectors of a twist by a unit quaternion. Costs little more than one product q * v,
/// and has the bits of two.
Twist turned(const Quaternion& q, const Twist& x);
/// Rotates a wrench by a quaternion or a matrix.
template <class Rotation>
Wrench turned(const Rotation& R, const Wrench& f) {
  return {R * f.torque, R * f.force};
}

/// Rotation vector of a unit quaternion [rad], length <= pi; accurate for tiny rotations, too.
Vector3 rotationVector(const Quaternion& q);

/// True if the angle of the rotation from attitude a to attitude b exceeds a limit [rad]. Computes
/// the angle only where a bound by the sine of its half does not decide.
bool isTurnedFurther(const Quaternion& a, const Quaternion& b, double limit);

}  // namespace ambient
