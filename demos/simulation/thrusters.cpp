#include "demos/simulation/thrusters.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ambient {

Thrusters::Thrusters(const Scene& scene, const std::vector<PreparedBody>& bodies)
    : defs_(scene.thrusters), arms_(defs_.size()), drives_(defs_.size()), states_(defs_.size()) {
  const auto washes = [](const ThrusterDef& def) { return def.washes_bodies; };
  jets_.reserve(static_cast<std::size_t>(std::count_if(defs_.begin(), defs_.end(), washes)));
  for (std::size_t i = 0; i < defs_.size(); ++i) {
    drives_[i].has_disc = defs_[i].propeller || defs_[i].radius > 0;
    setFactors(i, 1, 1);
    command(i, defs_[i].command);
    setCentre(defs_[i].body, bodies[defs_[i].body].centre_of_mass);
  }
}

void Thrusters::setCentre(std::size_t body, const Vector3& centre_of_mass) {
  for (std::size_t i = 0; i < defs_.size(); ++i) {
    const ThrusterDef& def = defs_[i];
    if (def.body != body) continue;
    arms_[i] = def.position - centre_of_mass;
    drives_[i].per_thrust =
        stack(arms_[i].cross(def.axis) + def.torque_per_thrust * def.axis, def.axis);
  }
}

void Thrusters::command(std::size_t index, double value) {
  if (!std::isfinite(value))
    throw std::invalid_argument("the command of thruster \"" + defs_.at(index).name +
                                "\" is not finite");
  drives_.at(index).command = value;
  setAsked(index);
}

void Thrusters::setAsked(std::size_t index) {
  Drive& drive = drives_[index];
  const double factor = defs_[index].propeller ? 1 : drive.thrust_factor;
  drive.asked = factor * valueAt(defs_[index].curve, drive.command);
}

void Thrusters::setStates(const std::vector<ThrusterState>& states) {
  std::copy(states.begin(), states.end(), states_.begin());
}

void Thrusters::setFactors(std::size_t index, double thrust, double lag) {
  drives_.at(index).thrust_factor = thrust;
  drives_[index].lag = lag * defs_[index].lag;
  setAsked(index);
}

void Thrusters::follow(double time_step) {
  for (std::size_t i = 0, count = defs_.size(); i < count; ++i) {
    const Drive& to = drives_[i];
    double& drive = states_[i].drive;
    drive += (to.asked - drive) * (time_step / (to.lag + time_step));
    if (!to.has_disc || !defs_[i].propeller) states_[i].load.thrust = drive;
  }
}

Vector3 Thrusters::velocityIn(const Medium& medium, std::size_t index,
                              const MotionSample& pose) const {
  const Vector3 velocity = pose.twist.at(pose.orientation * arms_[index]) - medium.velocity;
  return pose.orientation.conjugate() * velocity;
}

double Thrusters::wetShareOf(std::size_t index, const RegionSample& fluid) const {
  return std::clamp(0.5 + fluid.height / (2 * defs_[index].radius), 0.0, 1.0);
}

Vector3 Thrusters::washAt(const Vector3& point, bool is_above) const {
  Vector3 sum = Vector3::Zero();
  for (const Jet& jet : jets_) {
    if (jet.is_above != is_above) continue;
    const ThrusterState& state = states_[jet.thruster];
    const Vector3 way = point - jet.place;
    const double distance = way.dot(jet.away);
    const Wash wash =
        washOf(state.load.induced, state.advance, defs_[jet.thruster].radius, distance);
    if (!(wash.radius > 0)) continue;
    sum += wash.velocity * wash.shareAt((way - distance * jet.away).norm()) * jet.away;
  }
  return sum;
}

// A disc in two fluids has the share in the lower one; above it, all of the upper.
Wrench Thrusters::wrenchIn(const RegionSample& fluid, std::size_t index, const MotionSample& pose) {
  const ThrusterDef& def = defs_[index];
  double wet = wetShareOf(index, fluid);
  ThrusterState& state = states_[index];
  PropellerLoad& load = state.load;
  Vector3 drag = Vector3::Zero();
  if (def.propeller) {
    const Medium& medium = wet > 0 ? fluid.below : fluid.above;
    if (!(wet > 0)) wet = 1;
    const Vector3 velocity = velocityIn(medium, index, pose);
    state.advance = velocity.dot(def.axis);
    state.density = wet * medium.density;
    load = drives_[index].thrust_factor *
           def.propeller->load(state.drive, state.advance, medium.density);
    const Vector3 across = velocity - state.advance * def.axis;
    drag = -def.propeller->dragAcross(load, state.drive, state.advance, across.norm()) * across;
  }
  Wrench wrench = Wrench::fromVector(wet * load.thrust * drives_[index].per_thrust);
  wrench.force += wet * drag;
  wrench.torque += wet * arms_[index].cross(drag);
  wrench.torque -= (def.is_left_handed ? -wet : wet) * load.torque * def.axis;
  return wrench;
}

}  // namespace ambient
