#include "bullet_ambient/motion/row_velocity.h"

#include <Eigen/LU>
#include <cmath>

#include "bullet_ambient/motion/kirchhoff.h"
#include "bullet_ambient/motion/passive_kick.h"

namespace ambient {
namespace {

constexpr int kNewtonSteps = 3;

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

Turn classifyTurn(const BodyModel& model, const Vector6& gyroscopic_change, const Vector6& x,
                  double duration) noexcept {
  const double part_sq = inertiaNormSquared(model, gyroscopic_change);
  const double motion_sq = inertiaNormSquared(model, x);
  const double angle = x.head<3>().norm() * duration;
  const auto exceeds = [&](double part, double limit) {
    return part_sq > part * part * motion_sq || angle > limit;
  };
  if (exceeds(0.5, 1)) return Turn::kWild;
  return exceeds(0.15, 0.5) ? Turn::kStiff : Turn::kSlow;
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
  const Vector6 gyroscopic =
      dt * (model.inverse_inertia * gyroscopicWrench(model.inertia, relative).vector());
  result.turn = classifyTurn(model, gyroscopic, x, dt);
  Twist turned;
  if (result.turn != Turn::kWild) {
    Twist mean = relative;
    Vector6 change = gyroscopic;
    if (result.turn == Turn::kStiff) {
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
