#include "demos/pybullet/equipment.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <stdexcept>

#include "demos/scene/scene_parts.h"

namespace ambient::pybullet {
namespace {

/// Reads "3" or "3/0". @throws std::invalid_argument for any other text
std::pair<int, int> numbersIn(const std::string& text) {
  int body = -1, link = -1;
  const char* const end = text.data() + text.size();
  const char* at = std::from_chars(text.data(), end, body).ptr;
  if (at < end && *at == '/') at = std::from_chars(at + 1, end, link).ptr;
  if (at != end || body < 0)
    throw std::invalid_argument("equip: on is \"" + text +
                                "\"; must be numbers of a body, or of body/link");
  return {body, link};
}

/// Brings a place and axes from the frame of the centre of mass to F.
void toF(const FrameOffset& fluid_frame, Vector3& position, Vector3& axis) {
  position = fluid_frame.rotation.transpose() * (position - fluid_frame.translation);
  axis = fluid_frame.rotation.transpose() * axis;
}

/// F is the frame of the shape.
PreparedBody preparedIn(const FrameOffset& fluid_frame) {
  PreparedBody body;
  body.centre_of_mass = fluid_frame.rotation.transpose() * -fluid_frame.translation;
  return body;
}

template <class Defs>
auto findNamed(Defs& defs, const std::string& name) {
  return std::find_if(defs.begin(), defs.end(), [&](const auto& def) { return def.name == name; });
}

/// Refuses a name that something of the other kind has.
template <class Defs>
void requireNew(const Defs& others, const std::string& name) {
  if (findNamed(others, name) != others.end())
    throw std::invalid_argument("equip: a foil and a thruster are called \"" + name + "\"");
}

}  // namespace

// Adds the body that an entry is on, if it is new.
void Equipment::addCarrier(const nlohmann::json& entry, const WorldFluid& world) {
  const std::string on = entry.at("on").get<std::string>();
  if (findNamed(scene_.bodies, on) != scene_.bodies.end()) return;
  const auto [body, link] = numbersIn(on);
  world.require(body, link);
  scene_.bodies.emplace_back();
  scene_.bodies.back().name = on;
  scene_.bodies.back().mass = 1;  // it has one
  carriers_.push_back({body, link, false, world.frameOf(body, link), {}});
}

void Equipment::read(const nlohmann::json& values, const WorldFluid& world) {
  const auto none = nlohmann::json::array();
  for (const nlohmann::json& entry : values.value("thrusters", none)) {
    addCarrier(entry, world);
    ThrusterDef def = toThruster(entry, scene_);
    if (def.washes_bodies)
      throw std::invalid_argument("equip: thruster \"" + def.name +
                                  "\": washes_bodies is for scenes; here bodies feel no wash");
    requireNew(scene_.foils, def.name);
    toF(carriers_[def.body].fluid_frame, def.position, def.axis);
    scene_.thrusters.push_back(std::move(def));
  }
  for (const nlohmann::json& entry : values.value("foils", none)) {
    addCarrier(entry, world);
    FoilDef def = toFoil(entry, scene_);
    requireNew(scene_.thrusters, def.name);
    const FrameOffset& frame = carriers_[def.body].fluid_frame;
    toF(frame, def.foil.position, def.foil.chord_axis);
    def.foil.span_axis = frame.rotation.transpose() * def.foil.span_axis;
    scene_.foils.push_back(std::move(def));
  }
}

void Equipment::add(const Command& command, WorldFluid& world,
                    const WorldFluid::Settings& settings) {
  Equipment grown = *this;
  grown.read(command.values, world);
  std::vector<PreparedBody> bodies;
  for (const Carrier& carrier : grown.carriers_) bodies.push_back(preparedIn(carrier.fluid_frame));
  grown.thrusters_ = Thrusters(grown.scene_, bodies);
  grown.foils_ = SceneFoils(grown.scene_, bodies);
  grown.restore(saved());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (const Carrier& on = grown.carriers_[i]; !on.is_gone && grown.foils_.of(i))
      world.giveFoils(on.body, on.link, grown.foils_.of(i), settings);
  *this = std::move(grown);
}

void Equipment::restore(const State& state) {
  thrusters_.setStates(state.thrusters);
  std::vector<double> angles = foils_.angles();
  std::copy(state.foil_angles.begin(), state.foil_angles.end(), angles.begin());
  foils_.setAngles(angles);
}

void Equipment::drive(const Command& command) {
  for (const auto& [name, value] : command.values.items()) {
    const auto thruster = findNamed(scene_.thrusters, name);
    const auto foil = findNamed(scene_.foils, name);
    const bool is_thruster = thruster != scene_.thrusters.end();
    if (name.empty() || !(is_thruster || foil != scene_.foils.end()))
      command.fail("there is no foil or thruster \"" + name + "\"");
    const double asked = value.get<double>();
    if (is_thruster) {
      thrusters_.command(static_cast<std::size_t>(thruster - scene_.thrusters.begin()), asked);
      thruster->command = asked;
    } else {
      foils_.command(static_cast<std::size_t>(foil - scene_.foils.begin()), asked);
      foil->command = asked;
    }
  }
}

// Their places in the lists stay: indices count on them.
void Equipment::forget(int body, int link) {
  for (std::size_t i = 0; i < carriers_.size(); ++i) {
    const bool is_link = link == WorldFluid::kAllLinks || carriers_[i].link == link;
    if (carriers_[i].body != body || !is_link) continue;
    carriers_[i].is_gone = true;
    scene_.bodies[i].name.clear();
    for (ThrusterDef& def : scene_.thrusters)
      if (def.body == i) def.name.clear();
    for (FoilDef& def : scene_.foils)
      if (def.body == i) def.name.clear();
  }
}

void Equipment::push(double time_step, WorldFluid& world,
                     const std::function<const FluidRegion*(RegionId)>& regionOf) {
  thrusters_.follow(time_step);
  foils_.follow(time_step);
  const auto poseOf = [&](std::size_t i) {
    const Carrier& on = carriers_[i];
    return on.is_gone ? MotionSample() : world.motionInF(on.body, on.link);
  };
  const auto fluidAt = [&](std::size_t i, const Vector3& place) {
    RegionSample everywhere;
    everywhere.height = std::numeric_limits<double>::infinity();
    if (carriers_[i].is_gone) return everywhere;
    const Immersed body = world.require(carriers_[i].body, carriers_[i].link);
    if (const FluidRegion* region = regionOf(body.region()))
      return sampleRegion(*region, place, world.fluid().time());
    everywhere.below = everywhere.above = body.medium();
    return everywhere;
  };
  std::vector<Wrench> sums(carriers_.size());
  const auto apply = [&](std::size_t i, const Wrench& wrench) { sums[i] += wrench; };
  thrusters_.push(poseOf, fluidAt, apply);
  foils_.pushByWash(thrusters_, poseOf, fluidAt, apply);
  for (std::size_t i = 0; i < carriers_.size(); ++i)
    if (!carriers_[i].is_gone)
      world.push(carriers_[i].body, carriers_[i].link, sums[i], carriers_[i].push);
}

nlohmann::ordered_json Equipment::state() const {
  nlohmann::ordered_json state{{"thrusters", nlohmann::ordered_json::object()},
                               {"foils", nlohmann::ordered_json::object()}};
  for (std::size_t i = 0; i < scene_.thrusters.size(); ++i) {
    const ThrusterState& now = thrusters_.states()[i];
    if (!scene_.thrusters[i].name.empty())
      state["thrusters"][scene_.thrusters[i].name] = {{"command", thrusters_.command(i)},
                                                      {"drive", now.drive},
                                                      {"thrust", now.load.thrust},
                                                      {"torque", now.load.torque},
                                                      {"power", now.load.power}};
  }
  for (std::size_t i = 0; i < scene_.foils.size(); ++i)
    if (!scene_.foils[i].name.empty())
      state["foils"][scene_.foils[i].name] = {{"command", foils_.command(i)},
                                              {"angle", foils_.angle(i)}};
  return state;
}

}  // namespace ambient::pybullet
