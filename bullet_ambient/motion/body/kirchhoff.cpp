#include "bullet_ambient/motion/body/kirchhoff.h"

#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

Wrench gyroscopicWrench(const DualPair& motion) {
  return gyroscopicWrench(Momentum::fromVector(motion.momentum), Twist::fromVector(motion.twist));
}

WorldMomentum worldMomentum(const BodyModel& model, const RigidState& state) {
  const Vector6 m = pairOfTwist(model, state.twist.vector()).momentum;
  const Twist m_W = turned(state.orientation, Twist::fromVector(m));
  return {m_W.linear, m_W.angular, state.position};
}

Twist twistOf(const BodyModel& model, const WorldMomentum& momentum, const Quaternion& orientation,
              const Vector3& position) {
  const Vector3 about_centre =
      momentum.angular - (position - momentum.pivot).cross(momentum.linear);
  const Matrix3 to_body = orientation.toRotationMatrix().transpose();
  const Momentum m{to_body * about_centre, to_body * momentum.linear};
  return Twist::fromVector(pairOfMomentum(model, m.vector()).twist);
}

}  // namespace ambient
