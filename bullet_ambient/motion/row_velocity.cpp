#include "bullet_ambient/motion/row_velocity.h"

#include <Eigen/LU>
#include <cmath>

#include "bullet_ambient/motion/kirchhoff.h"
#include "bullet_ambient/motion/passive_kick.h"

namespace ambient {
namespace {

constexpr double kStiffGyroscopicPart = 0.15;  // of the state, in the norm of K
constexpr double kStiffTurn = 0.5;             // [rad] per step
constexpr double kWildGyroscopicPart = 0.5;    // beyond, no velocity holds for the whole step
constexpr double kWildTurn = 1.0;
constexpr int kNewtonSteps = 3;

enum class Turning { kSmooth, kStiff, kWild };

Turning classify(const BodyModel& model, const Vector6& gyroscopic, const Vector6& x, double dt) {
  const double part_sq = inertiaNormSquared(model, gyroscopic);
  const double motion_sq = inertiaNormSquared(model, x);
  const double turn = x.head<3>().norm() * dt;
  const auto exceeds = [&](double part, double angle) {
    return part_sq > part * part * motion_sq || turn > angle;
  };
  if (exceeds(kWildGyroscopicPart, kWildTurn)) return Turning::kWild;
  return exceeds(kStiffGyroscopicPart, kStiffTurn) ? Turning::kStiff : Turning::kSmooth;
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
  const Turning turning = classify(model, gyroscopic, x, dt);
  result.is_stiff = turning != Turning::kSmooth;
  Twist turned;
  if (turning != Turning::kWild) {
    Twist mean = relative;
    Vector6 change = gyroscopic;
    if (turning == Turning::kStiff) {
      const Vector6 mid = implicitMidpoint(model, x, model.inertia * (impulse / dt), dt);
      mean = Twist::fromVector(mid);
      change = 2 * (mid - x) - impulse;
    }
    turned = Twist::fromVector(change);
    // Body axes turn: d(v)/dt in world axes is v' + w x v.
    turned.linear += dt * mean.angular.cross(mean.linear);
  }
  const Quaternion& q = start.orientation;
  result.turning_W = {q * turned.angular, q * turned.linear};
  result.change_W.angular = result.turning_W.angular + q * impulse.head<3>();
  result.change_W.linear =
      result.turning_W.linear + q * impulse.tail<3>() + dt * s.ambient_acceleration;
  return result;
}

}  // namespace ambient
