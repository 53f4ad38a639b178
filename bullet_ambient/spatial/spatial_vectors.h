#pragma once

#include <Eigen/Geometry>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// 6-vector of rotation part and translation part. Eigen's comma initializer does the same at
/// several times the cost.
inline Vector6 stack(const Vector3& rotation, const Vector3& translation) {
  Vector6 x;
  x.head<3>() = rotation;
  x.tail<3>() = translation;
  return x;
}

/// Velocity of a rigid body in some frame: angular velocity w [rad/s] and linear velocity v [m/s]
/// of the frame's origin. As a 6-vector: rotation first.
struct Twist {
  Vector3 angular = Vector3::Zero();
  Vector3 linear = Vector3::Zero();

  static Twist fromVector(const Vector6& x) { return {x.head<3>(), x.tail<3>()}; }
  Vector6 vector() const { return stack(angular, linear); }
  /// Velocity [m/s] of the body point at `position` [m] from the frame's origin.
  Vector3 at(const Vector3& position) const { return linear + angular.cross(position); }
};

/// Torque about a frame's origin [N m] and force [N]. As a 6-vector: torque first.
struct Wrench {
  Vector3 torque = Vector3::Zero();
  Vector3 force = Vector3::Zero();

  static Wrench fromVector(const Vector6& f) { return {f.head<3>(), f.tail<3>()}; }
  /// Wrench of a force [N] that acts at `position` [m] from the frame's origin.
  static Wrench ofForceAt(const Vector3& force, const Vector3& position) {
    return {position.cross(force), force};
  }
  /// The wrench about the frame's origin, if this one is about `position` [m]; in the same axes.
  Wrench aboutOrigin(const Vector3& position) const {
    return {torque + position.cross(force), force};
  }
  Vector6 vector() const { return stack(torque, force); }
  Wrench& operator+=(const Wrench& other) {
    torque += other.torque;
    force += other.force;
    return *this;
  }
  Wrench& operator-=(const Wrench& other) {
    torque -= other.torque;
    force -= other.force;
    return *this;
  }
  friend Wrench operator+(Wrench a, const Wrench& b) { return a += b; }
  friend Wrench operator*(double s, const Wrench& f) { return {s * f.torque, s * f.force}; }
};

/// Angular momentum l about a frame's origin [kg m^2/s] and linear momentum p [kg m/s].
/// The 6-vector is (l, p) = K x, rotation first.
struct Momentum {
  Vector3 angular = Vector3::Zero();
  Vector3 linear = Vector3::Zero();

  static Momentum fromVector(const Vector6& m) { return {m.head<3>(), m.tail<3>()}; }
  Vector6 vector() const { return stack(angular, linear); }
};

/// Power of a wrench on a moving body [W]; both in one frame.
inline double power(const Wrench& f, const Twist& x) {
  return f.torque.dot(x.angular) + f.force.dot(x.linear);
}

inline Twist FrameOffset::toF(const Twist& x_B) const {
  return {rotation.transpose() * x_B.angular, rotation.transpose() * x_B.at(translation)};
}

inline Wrench FrameOffset::toB(const Wrench& f_F) const {
  const Vector3 force_B = rotation * f_F.force;
  return {rotation * f_F.torque + translation.cross(force_B), force_B};
}

}  // namespace ambient
