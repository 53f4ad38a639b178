#include "bullet_ambient/motion/row_velocity.h"

#include <Eigen/LU>
#include <cmath>

#include "bullet_ambient/motion/kirchhoff.h"
#include "bullet_ambient/motion/passive_kick.h"

namespace ambient {
namespace {

constexpr double kStiffGyroscopicPart = 0.15;  // of the state, in the norm of K
constexpr double kStiffTurn = 0.5;             // [rad] per step
constexpr int kNewtonSteps = 3;

bool isStiff(const BodyModel& model, const Vector6& gyroscopic, const Vector6& x, double dt) {
  const double limit = kStiffGyroscopicPart * kStiffGyroscopicPart * inertiaNormSquared(model, x);
  return inertiaNormSquared(model, gyroscopic) > limit || x.head<3>().norm() * dt > kStiffTurn;
}

// Twist in the middle of the step by the implicit midpoint rule for K dx/dt = gyroscopic(x) +
// wrench; the end of the step is 2 x_mid - x.
Vector6 implicitMidpoint(const BodyModel& model, const Vector6& x, const Vector6& wrench,
                         double duration) {
  Vector6 mid = x;
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Twist t = Twist::fromVector(mid);
    const Momentum m = Momentum::fromVector(model.inertia * mid);
    const Vector6 residual = model.inertia * (mid - x) -
                             duration / 2 * (gyroscopicWrench(model.inertia, t).vector() + wrench);
    Matrix6 by_momentum = Matrix6::Zero();  // d gyroscopic / d(l, p)
    by_momentum.topLeftCorner<3, 3>() = -crossMatrix(t.angular);
    by_momentum.topRightCorner<3, 3>() = -crossMatrix(t.linear);
    by_momentum.bottomRightCorner<3, 3>() = -crossMatrix(t.angular);
    Matrix6 by_twist = Matrix6::Zero();  // d gyroscopic / d(w, v) at fixed momentum
    by_twist.topLeftCorner<3, 3>() = crossMatrix(m.angular);
    by_twist.topRightCorner<3, 3>() = crossMatrix(m.linear);
    by_twist.bottomLeftCorner<3, 3>() = crossMatrix(m.linear);
    const Eigen::Matrix<double, 6, 6> jacobian =
        model.inertia - duration / 2 * (by_momentum * model.inertia + by_twist);
    mid -= jacobian.partialPivLu().solve(residual);
  }
  return mid;
}

// `end`, scaled down where it has more energy than `limit`. Gyroscopic terms have no power, but
// over a long step the turning of the body's axes would make some, and a body on a joint gain
// without end.
Vector6 withoutGain(const BodyModel& model, const Vector6& end, const Vector6& limit) {
  const double energy = inertiaNormSquared(model, end);
  const double allowed = inertiaNormSquared(model, limit);
  return energy > allowed ? Vector6(std::sqrt(allowed / energy) * end) : end;
}

}  // namespace

RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept {
  const BodyModel& model = task.model;
  const Surroundings& s = task.surroundings;
  const double dt = task.duration;
  RowVelocity result;
  Twist relative = start.twist;
  relative.linear -= start.orientation.conjugate() * s.ambient_velocity;
  const Vector6 x = relative.vector();

  Vector6 impulse =
      dt * (model.inverse_inertia * externalWrench(model, s, start.orientation).vector());
  if (model.has_surface_loads) {
    const SurfaceLoad load = computeSurfaceLoad(model, relative);
    result.count.load_evaluations = 1;
    result.count.guarded = load.guarded;
    // dt K^-1 F to first order, but it cannot reverse the motion however long the step.
    impulse += passiveKick(model, x, {x, load.wrench.vector()}, dt) - x;
  }
  const Vector6 gyroscopic =
      dt * (model.inverse_inertia * gyroscopicWrench(model.inertia, relative).vector());
  Twist mean = relative;
  Vector6 change = impulse + gyroscopic;
  const bool is_stiff = isStiff(model, gyroscopic, x, dt);
  if (is_stiff) {
    const Vector6 mid = implicitMidpoint(model, x, model.inertia * (impulse / dt), dt);
    mean = Twist::fromVector(mid);
    change = 2 * (mid - x);
  }
  // Body axes turn: d(v)/dt in world axes is v' + w x v.
  Twist body_change = Twist::fromVector(change);
  body_change.linear += dt * mean.angular.cross(mean.linear);
  if (is_stiff) {
    body_change = Twist::fromVector(withoutGain(model, x + body_change.vector(), x + impulse) - x);
  }
  result.change_W.angular = start.orientation * body_change.angular;
  result.change_W.linear = start.orientation * body_change.linear + dt * s.ambient_acceleration;
  return result;
}

}  // namespace ambient
