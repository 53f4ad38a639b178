#include "bullet_ambient/motion/flight/row_velocity.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/kirchhoff.h"
#include "bullet_ambient/motion/body/passive_kick.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {
namespace {

// Change of velocity dt K^-1 F by a wrench F over dt [s]; all in B.
Vector6 changeOfVelocity(const BodyModel& model, const Vector6& wrench, double dt) {
  if (model.has_diagonal_inertia)
    return (dt * model.inverse_inertia.diagonal()).cwiseProduct(wrench);
  return dt * (model.inverse_inertia * wrench);
}

}  // namespace

double extentOf(const BodyModel& model, const Vector6& change, const DualPair& motion,
                const TurnLimits& limits) noexcept {
  const double energy = inner(motion, motion);
  const double part = energy > 0 ? std::sqrt(inertiaNormSquared(model, change) / energy) : 0;
  return std::max(motion.twist.head<3>().norm() / limits.spin, part / limits.change);
}

Turning computeTurning(const BodyModel& model, const DualPair& motion, double duration) noexcept {
  AMBIENT_ASSERT(duration > 0);
  const Twist x = Twist::fromVector(motion.twist);
  Vector6 change = duration * pairOfMomentum(model, gyroscopicWrench(motion).vector()).twist;
  change.tail<3>() += duration * x.angular.cross(x.linear);
  return {change, extentOf(model, change, motion, {0.5 / duration, 0.45})};
}

RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept {
  const BodyModel& model = task.model;
  const Surroundings& s = task.surroundings;
  const double dt = task.duration;
  RowVelocity result;
  AMBIENT_ASSERT(dt > 0);
  Twist relative = start.twist;
  if (!s.ambient_velocity.isZero(0))
    relative.linear -= start.orientation.conjugate() * s.ambient_velocity;
  const DualPair motion = pairOfTwist(model, relative.vector());

  const Wrench external = externalWrench(model, s, start.orientation.toRotationMatrix());
  Vector6 impulse = changeOfVelocity(model, external.vector(), dt);
  if (model.loads) {
    const SurfaceLoad load = computeSurfaceLoad(model, relative, s.load_share);
    result.count.load_evaluations = 1;
    result.count.guarded = load.guarded;
    // Equal to dt K^-1 F to first order, but never reverses the motion, for any dt.
    const DualPair sample = pairOfMomentum(model, load.wrench.vector());
    impulse += passiveKick(motion, {motion, sample}, dt).twist - motion.twist;
  }
  const Turning turning = computeTurning(model, motion, dt);
  const Vector6 share = std::clamp(1 - turning.extent, 0.0, 0.5) * turning.change;
  result.extent = turning.extent;
  const Quaternion& q = start.orientation;
  result.turning_W = turned(q, Twist::fromVector(share));
  const Vector6 excess = model.even_response.beyond(pairOfTwist(model, impulse).momentum, impulse);
  if (!excess.isZero(0)) result.isotropic_excess_W = turned(q, Twist::fromVector(excess));
  const Twist impulse_W = turned(q, Twist::fromVector(impulse));
  result.change_W.angular = result.turning_W.angular + impulse_W.angular;
  result.change_W.linear = result.turning_W.linear + impulse_W.linear + dt * s.ambient_acceleration;
  return result;
}

}  // namespace ambient
