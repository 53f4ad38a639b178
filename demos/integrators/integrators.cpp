#include "demos/integrators/integrators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

namespace {

constexpr int kMostAttempts = 1024;
constexpr double kSafety = 0.9;
constexpr double kLeastChange = 0.2, kMostChange = 5;  // ratio of a substep to the one before
constexpr int kStages = 7;
constexpr double kRounding = 1e-12;

// Row i: weights of the rates 0 to i in stage i + 1. The last row is the solution of order 5; the
// rate at this solution is the first rate of the next substep.
constexpr double kWeights[kStages - 1][kStages - 1] = {
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
// Weights of order 5 minus those of order 4.
constexpr double kErrorWeights[kStages] = {
    71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

class Pair {
 public:
  Pair(const FlightTask& task, const RigidState& start, FlightCount& count)
      : task_(task), count_(count), equations_(task, start, count), now_(equations_.start()) {
    rates_[0] = equations_.rate(now_);
    speed_ = speedOf(equations_.start());
    push_ = pushOn(equations_.start());
  }

  // Tries a substep of length h [s]; returns its error over the tolerance.
  double attempt(double h) {
    for (int i = 0; i + 1 < kStages; ++i) {
      next_ = now_;
      for (int j = 0; j <= i; ++j) next_ = next_.plus(h * kWeights[i][j], rates_[j]);
      rates_[i + 1] = equations_.rate(next_);
    }
    return relativeError(h) / task_.settings.tolerance;
  }

  void accept(double h) {
    next_.orientation.normalize();
    now_ = next_;
    rates_[0] = rates_[kStages - 1];
    if (task_.model.loads) boundSpeed(h);
  }

  RigidState state() const { return equations_.stateOf(now_); }

 private:
  // Limits the growth of |x|_K to that by weight, buoyancy and applied forces, because loads only
  // take energy, docs/theory.md eq. (24). A body that chatters at a line of separation takes
  // hundreds of substeps with errors of one sign, each below the tolerance.
  void boundSpeed(double h) {
    const double push = pushOn(now_), bound = speed_ + h * std::max(push_, push);
    speed_ = speedOf(now_);
    push_ = push;
    if (!(speed_ > bound * (1 + kRounding))) return;
    const double scale = bound / speed_;
    now_.linear *= scale;
    now_.angular *= scale;
    count_.energy_removed += 0.5 * (speed_ * speed_ - bound * bound);
    rates_[0] = equations_.rate(now_);
    speed_ = bound;
  }

  // Norms in the metric of K: of the motion, and of the acceleration without surface loads.
  double speedOf(const MomentumPhase& phase) const {
    return std::sqrt(inertiaNormSquared(task_.model, equations_.stateOf(phase).twist.vector()));
  }
  double pushOn(const MomentumPhase& phase) const {
    const Matrix3 R = equations_.stateOf(phase).orientation.toRotationMatrix();
    const DualPair push =
        pairOfMomentum(task_.model, externalWrench(task_.model, task_.surroundings, R).vector());
    return std::sqrt(inner(push, push));
  }

  double relativeError(double h) const {
    MomentumPhase error{Eigen::Vector4d::Zero(), Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
    for (int i = 0; i < kStages; ++i) error = error.plus(h * kErrorWeights[i], rates_[i]);
    const BodyModel& model = task_.model;
    const RigidState end = equations_.stateOf(next_);
    const Quaternion to_body = end.orientation.conjugate();
    const Vector3 arm = end.position - equations_.start().position;
    const Momentum m{to_body * (error.angular - arm.cross(error.linear)), to_body * error.linear};
    const double change = std::sqrt(m.vector().dot(model.inverse_inertia * m.vector()));
    const double scale =
        std::sqrt(inertiaNormSquared(model, end.twist.vector())) + velocityScale(task_);
    const double turn = 2 * error.orientation.norm() / next_.orientation.norm();
    const double shift = error.position.norm();
    const double length = model.reference_length;
    const std::array<double, 3> errors = {change > 0 ? change / scale : change, turn,
                                          length > 0 ? shift / length : 0};
    const bool is_finite = std::isfinite(errors[0] + errors[1] + errors[2]);
    return is_finite ? *std::max_element(errors.begin(), errors.end())
                     : std::numeric_limits<double>::infinity();
  }

  const FlightTask& task_;
  FlightCount& count_;
  MomentumEquations equations_;
  MomentumPhase now_;
  MomentumPhase next_;
  double speed_ = 0;  ///< speedOf(now_) [sqrt(J)]
  double push_ = 0;   ///< pushOn(now_) [sqrt(J) / s]
  std::array<MomentumPhase, kStages> rates_;
};

}  // namespace

FlightResult flyDormandPrince(const FlightTask& task, const RigidState& start,
                              const FlightMemory& memory) noexcept {
  const int most = task.settings.max_substeps > 0 ? task.settings.max_substeps : kMostAttempts;
  FlightResult flight{start, {}, {}};
  FlightCount& count = flight.count;
  Pair pair(task, start, count);
  double h = memory.substep > 0 ? memory.substep : task.duration;
  double left = task.duration;
  AMBIENT_ASSERT(h > 0 && left > 0 && most > 0);
  while (left > 0 && count.substeps < most) {
    const bool is_last = h >= left * (1 - 1e-9);
    const double taken = is_last ? left : h;
    const double error = pair.attempt(taken);
    ++count.substeps;
    const double change =
        std::clamp(kSafety * portable::pow(error, -1.0 / 5), kLeastChange, kMostChange);
    if (error <= 1) {
      pair.accept(taken);
      left = is_last ? 0 : left - taken;
      // If only the end of the step shortened this substep, the next one may be as long as h.
      h = is_last ? std::max(h, taken * change) : taken * change;
    } else {
      h = taken * std::min(change, 1.0);
    }
  }
  flight.state = pair.state();
  if (left > 0) {
    Flight rest({task.model, task.surroundings, task.settings, left}, flight.state, {});
    Flight* const rests[] = {&rest};
    flyLeapfrog(rests, 1);
    flight.state = rest.body.state;
    flight.count.substeps += rest.body.count.substeps;
    flight.count.load_evaluations += rest.body.count.load_evaluations;
    flight.count.guarded += rest.body.count.guarded;
    flight.count.energy_removed += rest.body.count.energy_removed;
    flight.count.coarse = true;
    flight.count.error = 1;
  }
  flight.memory = {};
  flight.memory.substep = h;
  return flight;
}

namespace {

Quaternion unit(const Eigen::Vector4d& q) {
  return Quaternion(q[3], q[0], q[1], q[2]).normalized();
}

constexpr double kMaxTurn = 5.7 * kPi / 180;  // [rad] per substep
constexpr int kMostSubsteps = 4096;

MomentumPhase step(const MomentumEquations& equations, const MomentumPhase& s, double h) {
  const MomentumPhase k1 = equations.rate(s);
  const MomentumPhase k2 = equations.rate(s.plus(h / 2, k1));
  const MomentumPhase k3 = equations.rate(s.plus(h / 2, k2));
  const MomentumPhase k4 = equations.rate(s.plus(h, k3));
  MomentumPhase end = s.plus(h / 6, k1).plus(h / 3, k2).plus(h / 3, k3).plus(h / 6, k4);
  end.orientation.normalize();
  return end;
}

}  // namespace

MomentumEquations::MomentumEquations(const FlightTask& task, const RigidState& start,
                                     FlightCount& count)
    : task_(task), pivot_(start.position), count_(count) {
  const Vector6 momentum = pairOfTwist(task.model, start.twist.vector()).momentum;
  const Twist momentum_W = turned(start.orientation, Twist::fromVector(momentum));
  start_ = {start.orientation.coeffs(), start.position, momentum_W.linear, momentum_W.angular};
}

MomentumPhase MomentumEquations::rate(const MomentumPhase& s) const {
  const RigidState state = stateOf(s);
  const Quaternion& q = state.orientation;
  Wrench wrench = externalWrench(task_.model, task_.surroundings, q.toRotationMatrix());
  if (task_.model.loads) {
    const SurfaceLoad load = computeSurfaceLoad(task_.model, state.twist, task_.surroundings);
    ++count_.load_evaluations;
    count_.guarded += load.guarded;
    wrench += wholeLoad(load, task_.model.resistance.get(), state.twist);
  }
  const Vector3 force = q * wrench.force;
  const Vector3& w = state.twist.angular;
  return {0.5 * (q * Quaternion(0, w.x(), w.y(), w.z())).coeffs(), q * state.twist.linear, force,
          q * wrench.torque + (s.position - pivot_).cross(force)};
}

RigidState MomentumEquations::stateOf(const MomentumPhase& s) const {
  RigidState state;
  state.orientation = unit(s.orientation);
  state.position = s.position;
  // x = K^-1 (R^T (L - (y - pivot) x P), R^T P)
  const Vector3 about_centre = s.angular - (s.position - pivot_).cross(s.linear);
  const Matrix3 to_body = state.orientation.toRotationMatrix().transpose();
  const Momentum m{to_body * about_centre, to_body * s.linear};
  state.twist = Twist::fromVector(pairOfMomentum(task_.model, m.vector()).twist);
  return state;
}

FlightResult flyRungeKutta(const FlightTask& task, const RigidState& start,
                           const FlightMemory&) noexcept {
  const int most = task.settings.max_substeps > 0 ? task.settings.max_substeps : kMostSubsteps;
  const double wanted = std::ceil(start.twist.angular.norm() * task.duration / kMaxTurn);
  const int substeps = wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
  FlightResult flight{start, {}, {}};
  flight.count.substeps = substeps;
  flight.count.coarse = wanted > most;
  flight.count.error = flight.count.coarse ? 1 : 0;
  const MomentumEquations equations(task, start, flight.count);
  MomentumPhase s = equations.start();
  for (int i = 0; i < substeps; ++i) s = step(equations, s, task.duration / substeps);
  flight.state = equations.stateOf(s);
  return flight;
}

FlightResult flySymplecticEuler(const FlightTask& task, const RigidState& start,
                                const FlightMemory&) noexcept {
  const BodyModel& model = task.model;
  FlightResult flight{start, {}, {}};
  flight.count.substeps = std::max(1, task.settings.max_substeps);
  const double h = task.duration / flight.count.substeps;
  RigidState& s = flight.state;
  for (int i = 0; i < flight.count.substeps; ++i) {
    Wrench wrench = externalWrench(model, task.surroundings, s.orientation.toRotationMatrix()) +
                    gyroscopicWrench(pairOfTwist(model, s.twist.vector()));
    if (model.loads) {
      const SurfaceLoad load = computeSurfaceLoad(model, s.twist, task.surroundings);
      ++flight.count.load_evaluations;
      flight.count.guarded += load.guarded;
      wrench += wholeLoad(load, model.resistance.get(), s.twist);
    }
    s.twist = Twist::fromVector(s.twist.vector() + h * (model.inverse_inertia * wrench.vector()));
    s.orientation = (s.orientation * rotationFromVector(h * s.twist.angular)).normalized();
    s.position += h * (s.orientation * s.twist.linear);
  }
  return flight;
}

}  // namespace ambient
