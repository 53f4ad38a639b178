#include "bullet_ambient/motion/row_velocity.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/motion/kirchhoff.h"
#include "bullet_ambient/motion/passive_kick.h"

namespace ambient {

double extentOf(const BodyModel& model, const Vector6& change, const Vector6& x,
                const TurnLimits& limits) noexcept {
  const double energy = inertiaNormSquared(model, x);
  const double part = energy > 0 ? std::sqrt(inertiaNormSquared(model, change) / energy) : 0;
  return std::max(x.head<3>().norm() / limits.spin, part / limits.change);
}

Turning computeTurning(const BodyModel& model, const Twist& x, double duration) noexcept {
  Vector6 change =
      duration * pairOfMomentum(model, gyroscopicWrench(model.inertia, x).vector()).twist;
  change.tail<3>() += duration * x.angular.cross(x.linear);
  return {change, extentOf(model, change, x.vector(), {0.5 / duration, 0.45})};
}

RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept {
  const BodyModel& model = task.model;
  const Surroundings& s = task.surroundings;
  const double dt = task.duration;
  RowVelocity result;
  Twist relative = start.twist;
  relative.linear -= start.orientation.conjugate() * s.ambient_velocity;
  const Vector6 x = relative.vector();

  Vector6 impulse = dt * (model.inverse_inertia *
                          externalWrench(model, s, start.orientation.toRotationMatrix()).vector());
  if (model.loads) {
    const SurfaceLoad load = computeSurfaceLoad(model, relative);
    result.count.load_evaluations = 1;
    result.count.guarded = load.guarded;
    // dt K^-1 F to first order, but it cannot reverse the motion however long the step.
    const DualPair motion = pairOfTwist(model, x);
    const DualPair sample = pairOfMomentum(model, load.wrench.vector());
    impulse += passiveKick(motion, {motion, sample}, dt).twist - x;
  }
  const Turning turning = computeTurning(model, relative, dt);
  const Vector6 share = std::clamp(1 - turning.extent, 0.0, 0.5) * turning.change;
  result.extent = turning.extent;
  const Quaternion& q = start.orientation;
  result.turning_W = {q * share.head<3>(), q * share.tail<3>()};
  const Vector6 aside = model.even_response.beyond(pairOfTwist(model, impulse).momentum, impulse);
  result.aside_W = {q * aside.head<3>(), q * aside.tail<3>()};
  result.change_W.angular = result.turning_W.angular + q * impulse.head<3>();
  result.change_W.linear =
      result.turning_W.linear + q * impulse.tail<3>() + dt * s.ambient_acceleration;
  return result;
}

}  // namespace ambient
