#include "demos/integrators/momentum_equations.h"

namespace ambient {
namespace {

Quaternion unit(const Eigen::Vector4d& q) {
  return Quaternion(q[3], q[0], q[1], q[2]).normalized();
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

}  // namespace ambient
