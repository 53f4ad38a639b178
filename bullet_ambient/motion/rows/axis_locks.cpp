#include "bullet_ambient/motion/rows/axis_locks.h"

#include <Eigen/LU>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/lanes/viscous_kernel.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

constexpr int kLockedNewtonSteps = 4;

Vector6 projectionOf(const AxisFactors& factors) {
  return stack(factors.angular, factors.linear).unaryExpr([](double f) {
    return f != 0 ? 1.0 : 0.0;
  });
}

// Accelerations in body axes if `response` replaces K^-1; `forced`: acceleration by all forces.
class LockedRates {
 public:
  LockedRates(const Matrix6& inertia, const Matrix6& response, const Vector6& forced)
      : inertia_(inertia), response_(response), forced_(forced) {}

  // Acceleration of the velocity in world axes, written in body axes.
  Vector6 acceleration(const Vector6& x) const {
    const Vector6 gyroscopic = gyroscopicWrench({x, inertia_ * x}).vector();
    return response_ * (gyroscopic + inertia_ * turning(x)) + forced_;
  }
  // (0, w x v): acceleration in world axes minus the rate of the twist in body axes.
  static Vector6 turning(const Vector6& x) {
    return stack(Vector3::Zero(), x.head<3>().cross(x.tail<3>()));
  }
  // d(acceleration - turning)/dx
  Matrix6 jacobian(const Vector6& x) const {
    const Vector6 m = inertia_ * x;
    const Matrix3 w = crossMatrix(x.head<3>()), v = crossMatrix(x.tail<3>());
    const Matrix3 l = crossMatrix(m.head<3>()), p = crossMatrix(m.tail<3>());
    Matrix6 by_momentum = Matrix6::Zero(), by_twist = Matrix6::Zero(), turned = Matrix6::Zero();
    by_momentum << -w, -v, Matrix3::Zero(), -w;
    by_twist << l, p, p, Matrix3::Zero();
    turned << Matrix3::Zero(), Matrix3::Zero(), -v, w;
    return response_ * (by_momentum * inertia_ + by_twist + inertia_ * turned) - turned;
  }

 private:
  const Matrix6& inertia_;
  const Matrix6& response_;
  const Vector6& forced_;
};

Vector6 midpoint(const LockedRates& rates, const Vector6& x, double dt) {
  Vector6 mid = x;
  for (int i = 0; i < kLockedNewtonSteps; ++i) {
    const Vector6 residual =
        mid - x - dt / 2 * (rates.acceleration(mid) - LockedRates::turning(mid));
    const Eigen::Matrix<double, 6, 6> jacobian = Matrix6::Identity() - dt / 2 * rates.jacobian(mid);
    mid -= jacobian.partialPivLu().solve(residual);
  }
  return mid;
}

// Adds the mean acceleration over the step by a load at a twist relative to the fluid, and by the
// resistance. `locked`: the model of the task with the inverse inertia that the locks leave.
void addLoad(const SurfaceLoad& load, const FlightTask& task, const BodyModel& locked,
             const Twist& relative, Vector6& acceleration) {
  const double dt = task.duration;
  const Vector6 x = relative.vector();
  const PairsOf<double> motion = plain(pairOfTwist(locked, x));
  if (turnsWithFluid(task.surroundings)) {
    const Wrench mean = meanLoadInTurningFluid(task, locked, relative, load.wrench);
    acceleration += locked.inverse_inertia * mean.vector();
  } else {
    // The wrench that K^-1 would need for the acceleration that the locks allow.
    const PairsOf<double> sample =
        plain(pairOfTwist(locked, locked.inverse_inertia * load.wrench.vector()));
    acceleration += (asEigen(passiveKick(motion, motion, sample, dt).twist) - x) / dt;
  }
  if (!locked.resistance || !(load.growth.translation > 0)) return;
  const SymmetricOf<double> K = plain(task.model.inertia);
  const SymmetricOf<double> inverse = plain(task.model.inverse_inertia);
  const SymmetricOf<double> C = plain(locked.resistance->grown(load.growth));
  const Settling<double> terms(K, inverse, C);
  const Vector6 settled =
      asEigen((settle<double>(motion, noWrench<double>(), terms, 0, dt) - motion).momentum);
  acceleration += locked.inverse_inertia * settled / dt;
}

}  // namespace

Matrix6 freeInertia(const Matrix6& inertia_W, const AxisFactors& factors) {
  const Vector6 free = projectionOf(factors);
  Matrix6 result = free.asDiagonal() * inertia_W * free.asDiagonal();
  result.diagonal() += Vector6::Ones() - free;
  return result;
}

Matrix6 lockedInverse(const Matrix6& inertia_W, const AxisFactors& factors) {
  AMBIENT_ASSERT(isSymmetric(inertia_W, 1e-9));
  const Matrix6 inverse = Cholesky<6>(freeInertia(inertia_W, factors)).inverse();
  const Vector6 scale = stack(factors.angular, factors.linear);
  const Matrix6 scaled = scale.asDiagonal() * inverse * scale.asDiagonal();
  return 0.5 * (scaled + scaled.transpose());
}

Twist onFreeAxes(const Twist& change_W, const AxisFactors& factors) {
  const Vector6 free = projectionOf(factors);
  return {free.head<3>().cwiseProduct(change_W.angular),
          free.tail<3>().cwiseProduct(change_W.linear)};
}

Twist lockedChange(const Matrix6& inertia, const Matrix3& R, const AxisFactors& factors,
                   const Vector6& change_B) {
  const Vector6 momentum_B = inertia * change_B;
  const Vector6 momentum_W = stack(R * momentum_B.head<3>(), R * momentum_B.tail<3>());
  return Twist::fromVector(lockedInverse(rotateAxes(inertia, R), factors) * momentum_W);
}

RowVelocity computeLockedVelocity(const FlightTask& task, const RigidState& start,
                                  const AxisFactors& factors) noexcept {
  const Surroundings& s = task.surroundings;
  const double dt = task.duration;
  AMBIENT_ASSERT(dt > 0);
  const Matrix3 R = start.orientation.toRotationMatrix();
  Twist relative = start.twist;
  relative.linear -= R.transpose() * s.ambient_velocity;
  const Vector6 x = relative.vector();

  RowVelocity result;
  SurfaceLoad load;
  if (task.model.loads) {
    load = computeSurfaceLoad(task.model, relative, s);
    result.count.load_evaluations = 1;
    result.count.guarded = load.guarded;
    result.settled_inertia = settledInertia(task.model, load, relative, dt);
  }
  BodyModel model = task.model;
  const Matrix6& row_inertia = result.settled_inertia ? *result.settled_inertia : model.inertia;
  model.inverse_inertia =
      rotateAxes(lockedInverse(rotateAxes(row_inertia, R), factors), R.transpose());
  model.has_diagonal_inertia = false;
  Vector6 forced = model.inverse_inertia * externalWrench(model, s, R).vector();
  if (result.settled_inertia) {
    forced += model.inverse_inertia * wholeLoad(load, model.resistance.get(), relative).vector();
  } else if (model.loads) {
    addLoad(load, task, model, relative, forced);
  }
  const LockedRates rates(model.inertia, model.inverse_inertia, forced);
  const DualPair turned = pairOfTwist(model, dt * (rates.acceleration(x) - forced));
  result.extent = extentOf(plain(turned), plain(pairOfTwist(model, x)), 1 / dt, 0.3);
  Vector6 turning = Vector6::Zero();
  if (result.extent <= 1) turning = dt * (rates.acceleration(midpoint(rates, x, dt)) - forced);
  const auto inWorld = [&](const Vector6& change) {
    return onFreeAxes({R * change.head<3>(), R * change.tail<3>()}, factors);
  };
  result.turning_W = inWorld(turning);
  const Vector6 kick = dt * forced;
  result.change_W = inWorld(turning + kick);
  const Vector6 push = inWorld(row_inertia * kick).vector();  // momentum along free axes, in W
  const Vector6 push_B = stack(R.transpose() * push.head<3>(), R.transpose() * push.tail<3>());
  result.isotropic_excess_W = inWorld(model.even_response.beyond(push_B, kick));
  result.change_W.linear +=
      dt * onFreeAxes({Vector3::Zero(), s.ambient_acceleration}, factors).linear;
  return result;
}

}  // namespace ambient
