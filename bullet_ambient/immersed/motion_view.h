#pragma once

#include "bullet_ambient/motion/body/body_model.h"

namespace ambient {

/// Pose and motion of a body or link at one moment, and gravity, as read from Bullet. Whatever
/// concerns the fluid reads this in place of Bullet's objects.
struct MotionView {
  RigidState state;          ///< pose in W, twist in B
  Twist twist_W;             ///< that twist in world axes
  Vector3 gravity{0, 0, 0};  ///< [m/s^2]
  double rounding = 0;       ///< relative rounding of Bullet's numbers

  const Vector3& centre() const { return state.position; }
  Matrix3 rotation() const { return state.orientation.toRotationMatrix(); }
};

/// Mass properties of a body or link as Bullet has them. Default: those of bodies that are not
/// dynamic, for which they serve until the body is.
struct InverseMass {
  double mass = 1;           ///< [1/kg]
  Vector3 inertia{1, 1, 1};  ///< of the principal moments [1/(kg m^2)]

  Vector3 moments() const { return inertia.cwiseInverse(); }
  friend bool operator==(const InverseMass& a, const InverseMass& b) {
    return a.mass == b.mass && a.inertia == b.inertia;
  }
};

}  // namespace ambient
