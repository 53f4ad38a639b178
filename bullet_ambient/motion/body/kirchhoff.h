#pragma once

#include "bullet_ambient/motion/body/body_model.h"

namespace ambient {

/// Gyroscopic wrench (l x w + p x v, p x w) of Kirchhoff's equations in B, docs/theory.md eq. (2):
/// K dx/dt = gyroscopic wrench + applied wrench, for a twist x with momentum (l, p) = K x.
inline Wrench gyroscopicWrench(const Momentum& m, const Twist& x) {
  return {m.angular.cross(x.angular) + m.linear.cross(x.linear), m.linear.cross(x.angular)};
}
Wrench gyroscopicWrench(const DualPair& x);

/// Linear and angular momentum of body and fluid in world axes, angular about `pivot`. Both are
/// constant without loads.
struct WorldMomentum {
  Vector3 linear;   ///< P [kg m/s]
  Vector3 angular;  ///< L about pivot [kg m^2/s]
  Vector3 pivot;    ///< [m]
};
WorldMomentum worldMomentum(const BodyModel& model, const RigidState& state);

/// Twist in B at a pose (y, R) for a given world momentum:
/// x = K^-1 (R^T (L - (y - pivot) x P), R^T P).
Twist twistOf(const BodyModel& model, const WorldMomentum& momentum, const Quaternion& orientation,
              const Vector3& position);

}  // namespace ambient
