#include "bullet_ambient/motion/rows/row_velocity.h"

#include <Eigen/LU>
#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

namespace {

void setIsotropicResponse(RowLanes& lanes, int body, const IsotropicResponse& response) {
  for (int row = 0; row < 3; ++row)
    setLane(lanes.isotropic_inverse_inertia[row], body, Vector3(response.inverse_inertia.row(row)));
  lanes.isotropic_inverse_mass[body] = response.inverse_mass;
}

}  // namespace

Wrench meanLoadInTurningFluid(const FlightTask& task, const BodyModel& model, const Twist& relative,
                              const Wrench& load) noexcept {
  const FlowAlongBody& flow = *task.surroundings.flow;
  Twist seen = relative;
  seen.angular -= flow.twists_B[0].angular;
  const Wrench whole = load + flow.at_rest_B;
  const PairsOf<double> motion = plain(pairOfTwist(model, seen.vector()));
  const PairsOf<double> sample = plain(pairOfTwist(model, model.inverse_inertia * whole.vector()));
  const Vector6 change =
      asEigen(passiveKick(motion, motion, sample, task.duration).twist - motion.twist);
  Wrench mean = Wrench::fromVector(model.inertia * change / task.duration);
  return mean -= flow.at_rest_B;
}

void setModels(const BodyModel* const* models, int count, RowLanes& lanes) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  if (count < kFlightLanes) lanes = {};
  setKinds(lanes, count, [&](int i) -> const BodyModel& { return *models[i]; });
  for (int i = 0; i < count; ++i) {
    lanes.active[i] = 1;
    setModel(lanes, i, *models[i]);
  }
}

std::optional<Matrix6> settledInertia(const BodyModel& model, const SurfaceLoad& load,
                                      const Twist& relative, double duration) noexcept {
  if (!(settlingIn(model, load.growth, duration) > 0)) return std::nullopt;
  const double energy = inertiaNormSquared(model, relative.vector());
  const double drag = energy > 0 ? std::max(0.0, -power(load.wrench, relative) / energy) : 0.0;
  const Matrix6 inertia =
      (1 + duration * drag) * model.inertia + duration * model.resistance->grown(load.growth);
  if (!inertia.allFinite() || !Cholesky<6>(inertia).isPositive()) return std::nullopt;
  return inertia;
}

namespace {

/// Sets the forces on a body with a mean wrench in B that acts over the step besides.
void setForcesWith(const Wrench& mean_B, const FlightTask& task, const Quaternion& orientation,
                   int lane, RowLanes& lanes) {
  Surroundings with = task.surroundings;
  with.applied += turned(orientation, mean_B);
  setForces(lanes, lane, {task.model, with, task.settings, task.duration});
}

/// Returns the mean wrench in B over the step of the load on a body whose motion rows may uphold,
/// eq. (28f). `last_B`: that of the last step. None where eq. (23) has to hold: the load stops the
/// body within a step, or what rows uphold has ended.
std::optional<Wrench> upheldLoad(const FlightTask& task, const Twist& relative,
                                 const Wrench& last_B, FlightCount& count) noexcept {
  const BodyModel& model = task.model;
  const Vector6 x = relative.vector();
  const DualPair motion = pairOfTwist(model, x);
  const double energy = inner(motion, motion);
  if (!(energy > 0) || turnsWithFluid(task.surroundings)) return std::nullopt;
  const TurningsOf<double> turning = computeTurnings<double>(
      plain(model.inertia), plain(model.inverse_inertia), plain(motion), task.duration);
  const Vector6 middle = x - turning.share() * asEigen(turning.change);
  const Twist seen = Twist::fromVector(middle);
  const SurfaceLoad load = computeSurfaceLoad(model, seen, task.surroundings);
  count.load_evaluations += 1;
  count.guarded = count.guarded || load.guarded;
  const Wrench whole = wholeLoad(load, model.resistance.get(), seen);
  const double seen_energy = inertiaNormSquared(model, middle);
  const double drag = seen_energy > 0 ? std::max(0.0, -power(whole, seen) / seen_energy) : 0.0;
  const double q = task.duration * drag;
  if (!(q < 1) || settlingIn(model, load.growth, task.duration) > 0) return std::nullopt;
  const Vector6 last = std::min(1.0, 2 - 2 * q) * last_B.vector();
  const Vector6 mean = last + (whole.vector() - last) / (1 + q);
  const Vector6 kicked = x + task.duration * (model.inverse_inertia * mean);
  if (!(inertiaNormSquared(model, kicked) <= energy)) return std::nullopt;
  return Wrench::fromVector(mean);
}

}  // namespace

RowLoad setStart(const FlightTask& task, const RigidState& start, const Wrench& last_W, int lane,
                 RowLanes& lanes) noexcept {
  const Surroundings& s = task.surroundings;
  AMBIENT_ASSERT(task.duration > 0);
  lanes.kick_time[lane] = task.duration;
  setForces(lanes, lane, task);
  setLane(lanes.acceleration_W, lane, s.ambient_acceleration);
  setIsotropicResponse(lanes, lane, task.model.isotropic_response);
  Twist relative = start.twist;
  if (!s.ambient_velocity.isZero(0))
    relative.linear -= start.orientation.conjugate() * s.ambient_velocity;
  setLane(lanes.orientation, lane, start.orientation);
  setLane(lanes.twist_B, lane, relative);
  setLane(lanes.load_B, lane, Wrench{});
  setResistance(lanes, lane, task.model.resistance.get());
  setGrowth(lanes, lane, {});
  lanes.settling[lane] = 0;
  RowLoad row;
  if (!task.model.loads) return row;
  const Wrench last_B = turned(start.orientation.conjugate(), last_W);
  if (const auto mean = upheldLoad(task, relative, last_B, row.count)) {
    setForcesWith(*mean, task, start.orientation, lane, lanes);
    row.mean_W = turned(start.orientation, *mean);
    return row;
  }
  const SurfaceLoad load = computeSurfaceLoad(task.model, relative, s);
  setGrowth(lanes, lane, task.model.resistance ? load.growth : Growth{});
  const bool is_constant = turnsWithFluid(s);
  row.settled_inertia =
      settledInertia(task.model, is_constant ? SurfaceLoad{{}, false, load.growth} : load, relative,
                     task.duration);
  if (row.settled_inertia)
    lanes.settling[lane] = settlingIn(task.model, load.growth, task.duration);
  if (is_constant) {
    setForcesWith(meanLoadInTurningFluid(task, task.model, relative, load.wrench), task,
                  start.orientation, lane, lanes);
  } else {
    setLane(lanes.load_B, lane, load.wrench);
  }
  row.count.load_evaluations += 1;
  row.count.guarded = row.count.guarded || load.guarded;
  return row;
}

RowVelocity rowVelocityOf(const RowLanes& lanes, int lane, const RowLoad& load) noexcept {
  return {twistOf(lanes.change_W, lane),
          twistOf(lanes.turning_W, lane),
          twistOf(lanes.isotropic_excess_W, lane),
          lanes.turn_number[lane],
          load.count,
          lanes.settling[lane] > 0 ? load.settled_inertia : std::nullopt};
}

RowVelocity computeRowVelocity(const FlightTask& task, const RigidState& start) noexcept {
  RowLanes lanes;
  const BodyModel* const model = &task.model;
  setModels(&model, 1, lanes);
  const RowLoad load = setStart(task, start, {}, 0, lanes);
  kFlightKernels.fastest()->predictRowVelocity(lanes);
  return rowVelocityOf(lanes, 0, load);
}

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
  result.turn_number = turnNumberOf(plain(turned), plain(pairOfTwist(model, x)), 1 / dt, 0.3);
  Vector6 turning = Vector6::Zero();
  if (result.turn_number <= 1) turning = dt * (rates.acceleration(midpoint(rates, x, dt)) - forced);
  const auto inWorld = [&](const Vector6& change) {
    return onFreeAxes({R * change.head<3>(), R * change.tail<3>()}, factors);
  };
  result.turning_W = inWorld(turning);
  const Vector6 kick = dt * forced;
  result.change_W = inWorld(turning + kick);
  const Vector6 push = inWorld(row_inertia * kick).vector();  // momentum along free axes, in W
  const Vector6 push_B = stack(R.transpose() * push.head<3>(), R.transpose() * push.tail<3>());
  result.isotropic_excess_W = inWorld(model.isotropic_response.beyond(push_B, kick));
  result.change_W.linear +=
      dt * onFreeAxes({Vector3::Zero(), s.ambient_acceleration}, factors).linear;
  return result;
}

}  // namespace ambient
