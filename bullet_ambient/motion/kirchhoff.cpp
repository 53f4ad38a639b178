#include "bullet_ambient/motion/kirchhoff.h"

namespace ambient {

Wrench gyroscopicWrench(const Matrix6& inertia, const Twist& x) {
  const Momentum m = Momentum::fromVector(inertia * x.vector());
  return {m.angular.cross(x.angular) + m.linear.cross(x.linear), m.linear.cross(x.angular)};
}

WorldMomentum worldMomentum(const BodyModel& model, const RigidState& state) {
  const Momentum m = Momentum::fromVector(model.inertia * state.twist.vector());
  return {state.orientation * m.linear, state.orientation * m.angular, state.position};
}

Twist twistOf(const BodyModel& model, const WorldMomentum& momentum, const Quaternion& orientation,
              const Vector3& position) {
  const Vector3 about_centre =
      momentum.angular - (position - momentum.pivot).cross(momentum.linear);
  const Matrix3 to_body = orientation.toRotationMatrix().transpose();
  const Momentum m{to_body * about_centre, to_body * momentum.linear};
  return Twist::fromVector(model.inverse_inertia * m.vector());
}

}  // namespace ambient
