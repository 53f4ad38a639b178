#pragma once

#include <LinearMath/btMatrix3x3.h>
#include <LinearMath/btQuaternion.h>
#include <LinearMath/btVector3.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

AMBIENT_BEGIN

inline Vector3 toVector3(const btVector3& v) {
  return {static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z())};
}
inline btVector3 toBullet(const Vector3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// Returns a vector with the numbers that Bullet keeps of it.
inline Vector3 rounded(const Vector3& v) { return toVector3(toBullet(v)); }

/// Smallest velocity [m/s] or [rad/s] that is given to Bullet. Below it, the square of half the
/// turn in a step is a subnormal number, with which processors compute many times slower.
inline double leastVelocity(double time_step) {
  return 2 * std::sqrt(static_cast<double>(std::numeric_limits<btScalar>::min())) / time_step;
}
/// Returns a velocity change with components below leastVelocity() set to 0. Keeps components that
/// are not finite.
inline Twist withoutTraces(const Twist& change, double time_step) {
  const double least = leastVelocity(time_step);
  const auto pick = [&](double a) { return std::abs(a) < least ? 0 : a; };
  return {change.angular.unaryExpr(pick), change.linear.unaryExpr(pick)};
}

/// Converts and normalises: the length is 1 to the rounding of a double, for float quaternions,
/// too.
inline Quaternion toQuaternion(const btQuaternion& q) {
  return Quaternion(static_cast<double>(q.w()), static_cast<double>(q.x()),
                    static_cast<double>(q.y()), static_cast<double>(q.z()))
      .normalized();
}
inline btQuaternion toBullet(const Quaternion& q) {
  return {static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()), static_cast<btScalar>(q.z()),
          static_cast<btScalar>(q.w())};
}

template <class Block>  // any 3x3 Eigen expression
btMatrix3x3 toBulletMatrix(const Block& m) {
  const auto s = [](double value) { return static_cast<btScalar>(value); };
  return {s(m(0, 0)), s(m(0, 1)), s(m(0, 2)), s(m(1, 0)), s(m(1, 1)),
          s(m(1, 2)), s(m(2, 0)), s(m(2, 1)), s(m(2, 2))};
}

AMBIENT_END
