#include "demos/integrators/integrators.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/spatial/rotation.h"
#include "demos/integrators/momentum_equations.h"

namespace ambient {
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
  const WorldMomentum momentum = worldMomentum(task.model, start);
  start_ = {start.orientation.coeffs(), start.position, momentum.linear, momentum.angular};
}

MomentumPhase MomentumEquations::rate(const MomentumPhase& s) const {
  const RigidState state = stateOf(s);
  const Quaternion& q = state.orientation;
  Wrench wrench = externalWrench(task_.model, task_.surroundings, q.toRotationMatrix());
  if (task_.model.loads) {
    const SurfaceLoad load = computeSurfaceLoad(task_.model, state.twist, task_.surroundings);
    ++count_.load_evaluations;
    count_.guarded += load.guarded;
    wrench += load.wrench;
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
  state.twist =
      twistOf(task_.model, {s.linear, s.angular, pivot_}, state.orientation, state.position);
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
      wrench += load.wrench;
    }
    s.twist = Twist::fromVector(s.twist.vector() + h * (model.inverse_inertia * wrench.vector()));
    s.orientation = (s.orientation * rotationFromVector(h * s.twist.angular)).normalized();
    s.position += h * (s.orientation * s.twist.linear);
  }
  return flight;
}

}  // namespace ambient
