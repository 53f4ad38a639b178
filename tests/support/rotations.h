#pragma once

#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

/// Unit quaternion of the smallest rotation from the direction of `from` to that of `to`. Opposite
/// directions give half a turn about an axis perpendicular to `from`. Lengths do not matter.
/// @pre neither is zero
inline Quaternion rotationBetween(const Vector3& from, const Vector3& to) {
  const Vector3 a = from.stableNormalized(), b = to.stableNormalized();
  const Vector3 between = a + b;  // length: 2 cos(half the angle)
  if (between.norm() > 1e-7) {
    const Vector3 half = between.normalized();
    const Vector3 axis = a.cross(half);
    return Quaternion(a.dot(half), axis.x(), axis.y(), axis.z()).normalized();
  }
  int least = 0;
  a.cwiseAbs().minCoeff(&least);
  const Vector3 axis = a.cross(Vector3(Vector3::Unit(least))).normalized();
  return Quaternion(0, axis.x(), axis.y(), axis.z());
}

/// Angle of the rotation from attitude a to attitude b [rad], in [0, pi].
inline double angleBetween(const Quaternion& a, const Quaternion& b) {
  return rotationVector(a.conjugate() * b).norm();
}

}  // namespace ambient
