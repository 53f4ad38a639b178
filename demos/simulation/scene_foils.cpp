#include "demos/simulation/scene_foils.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ambient {

SceneFoils::SceneFoils(const Scene& scene, const std::vector<PreparedBody>& bodies) {
  std::vector<std::vector<Foil>> on_bodies(scene.bodies.size());
  for (const FoilDef& def : scene.foils) {
    const PreparedBody& body = bodies[def.body];
    Placed placed;
    placed.def = def;
    placed.command = def.command;
    placed.index = on_bodies[def.body].size();
    placed.origin_S = body.fluid_origin;
    Foil foil = def.foil;
    foil.position -= body.fluid_origin;
    on_bodies[def.body].push_back(foil);
    for (std::size_t i = 0; i < scene.thrusters.size(); ++i)
      if (scene.thrusters[i].body == def.body && scene.thrusters[i].propeller)
        placed.thrusters.push_back(i);
    placed_.push_back(std::move(placed));
    setCentre(def.body, body.centre_of_mass);
  }
  std::vector<std::shared_ptr<Foils>> made(on_bodies.size());
  for (Placed& placed : placed_) {
    std::shared_ptr<Foils>& foils = made[placed.def.body];
    if (!foils) foils = std::make_shared<Foils>(on_bodies[placed.def.body]);
    placed.foils = foils;
  }
}

void SceneFoils::setCentre(std::size_t body, const Vector3& centre_of_mass) {
  for (Placed& placed : placed_) {
    if (placed.def.body != body) continue;
    placed.arm = placed.def.foil.position - centre_of_mass;
    placed.origin = placed.origin_S - centre_of_mass;
  }
}

std::shared_ptr<const Foils> SceneFoils::of(std::size_t body) const {
  for (const Placed& placed : placed_)
    if (placed.def.body == body) return placed.foils;
  return nullptr;
}

void SceneFoils::command(std::size_t index, double value) {
  if (!std::isfinite(value))
    throw std::invalid_argument("the command of foil \"" + def(index).name + "\" is not finite");
  placed_.at(index).command = value;
}

double SceneFoils::angle(std::size_t index) const {
  const Placed& placed = placed_.at(index);
  return placed.foils->angle(placed.index);
}

std::vector<double> SceneFoils::angles() const {
  std::vector<double> angles;
  for (std::size_t i = 0; i < size(); ++i) angles.push_back(angle(i));
  return angles;
}

void SceneFoils::setAngles(const std::vector<double>& angles) {
  for (std::size_t i = 0; i < size(); ++i) placed_[i].foils->turn(placed_[i].index, angles[i]);
}

void SceneFoils::follow(double time_step) {
  for (const Placed& placed : placed_) {
    if (placed.def.curve.empty()) continue;
    const double angle = placed.foils->angle(placed.index);
    const double asked = valueAt(placed.def.curve, placed.command);
    const double share = time_step / (placed.def.lag + time_step);
    placed.foils->turn(placed.index, angle + (asked - angle) * share);
  }
}

// The share of the span in the jet feels it, the rest does not, eq. (171).
Wrench SceneFoils::washOn(const Placed& placed, const Thrusters& thrusters, std::size_t thruster,
                          const MotionSample& pose, const RegionSample& fluid) {
  const ThrusterDef& disc = thrusters.def(thruster);
  const ThrusterState& state = thrusters.states()[thruster];
  const Foil& foil = placed.def.foil;
  const Vector3 away = state.load.induced < 0 ? disc.axis : Vector3(-disc.axis);
  const Vector3 way = foil.position - disc.position;
  const double distance = way.dot(away);
  const Wash wash = washOf(state.load.induced, state.advance, disc.radius, distance);
  const Vector3 half = foil.span / 2 * placed.foils->axesOf(placed.index).col(1);
  double share = wash.shareOf(way - distance * away, half - half.dot(away) * away);
  if (!(wash.radius > 0) || !(share > 0)) return {};
  double wet = std::clamp(0.5 + fluid.height / foil.span, 0.0, 1.0);
  const bool is_above = std::isfinite(fluid.height) && !(state.density > fluid.above.density);
  share *= is_above ? 1 - wet : wet;
  const Vector3 stream = (is_above ? fluid.above : fluid.below).velocity;
  const Quaternion to_body = pose.orientation.conjugate();
  Twist x{to_body * pose.twist.angular, to_body * (pose.twist.linear - stream)};
  x.linear = x.at(placed.origin);
  const Twist washed{x.angular, x.linear - wash.velocity * away};
  Wrench sum = placed.foils->load(placed.index, washed, share * state.density, nullptr);
  sum -= placed.foils->load(placed.index, x, share * state.density, nullptr);
  return sum.aboutOrigin(placed.origin);
}

}  // namespace ambient
