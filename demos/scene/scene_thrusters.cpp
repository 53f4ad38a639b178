#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "demos/scene/scene_parts.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/robot/robot_model.h"

namespace ambient {
namespace {

/// A body of a scene, and a frame in that of its shape or link.
struct Mount {
  std::size_t body;
  RigidPose pose = RigidPose::Identity();
};

std::optional<std::size_t> findBody(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].name == name) return i;
  return std::nullopt;
}

/// Finds a body, or a link robot/link that was merged into one, by its name.
std::optional<Mount> findMount(const Scene& scene, const std::string& name) {
  if (const auto body = findBody(scene, name)) return Mount{*body};
  for (const RobotDef& robot : scene.robots)
    for (const LinkModel& link : robot.model->links)
      for (const auto& [merged, pose] : link.merged) {
        if (robot.name + "/" + merged != name) continue;
        if (const auto body = findBody(scene, robot.name + "/" + link.name))
          return Mount{*body, pose};
      }
  return std::nullopt;
}

CommandCurve toCurve(const nlohmann::json& points, const std::string& place) {
  CommandCurve curve;
  for (const auto& point : points)
    curve.emplace_back(point[0].get<double>(), point[1].get<double>());
  for (std::size_t i = 1; i < curve.size(); ++i)
    if (!(curve[i].first > curve[i - 1].first))
      raiseInputError(place + "curve", "has the command ", curve[i].first, " after ",
                      curve[i - 1].first, "; must be above that");
  return curve;
}

/// Finds what an entry of a list is on, and gives it a name of its own in the list.
template <class Def>
Mount readPlace(const nlohmann::json& from, const Scene& scene, const std::string& place,
                const std::vector<Def>& others, const char* kind, Def& def) {
  const std::string on = from.at("on").get<std::string>();
  const auto mount = findMount(scene, on);
  if (!mount) raiseInputError(place + "on", "names \"", on, "\", which no body or link is called");
  if (!(scene.bodies[mount->body].mass > 0))
    raiseInputError(place + "on", "names \"", on, "\", which is static; must have a mass > 0");
  def.name = from.value("name", kind + std::to_string(others.size()));
  for (const Def& other : others)
    if (other.name == def.name)
      raiseInputError(place + "name", "\"", other.name, "\" is used twice");
  def.body = mount->body;
  return *mount;
}

/// Points of a table [J, thrust, torque], the last column times `per_torque`.
std::vector<PropellerPoint> toPoints(const nlohmann::json& table, double per_torque) {
  std::vector<PropellerPoint> points;
  for (const nlohmann::json& row : table)
    points.push_back(
        {row[0].get<double>(), row[1].get<double>(), per_torque * row[2].get<double>()});
  return points;
}

Propeller toPropeller(const nlohmann::json& from) {
  const double diameter = from.at("diameter").get<double>();
  const double astern = from.value("astern", PropellerExtras{}.astern);
  if (const auto screw = from.find("wageningen"); screw != from.end())
    return Propeller::wageningen(
        diameter, {screw->at("blades").get<int>(), screw->at("area_ratio").get<double>(),
                   screw->at("pitch_ratio").get<double>(), astern});
  const PropellerExtras extras{from.value("area_ratio", PropellerExtras{}.area_ratio), astern};
  if (from.contains("kt_kq"))
    return Propeller::byTable(diameter, toPoints(from.at("kt_kq"), 1), extras);
  if (from.contains("ct_cp"))
    return Propeller::byTable(diameter, toPoints(from.at("ct_cp"), 1 / (2 * kPi)), extras);
  return Propeller::idealDisc(diameter);
}

/// Sets the propeller of a thruster, its disc and its sense.
void readPropeller(const nlohmann::json& from, const std::string& place, ThrusterDef& thruster) {
  const nlohmann::json& propeller = from.at("propeller");
  if (from.contains("radius"))
    raiseInputError(place + "radius", "is given beside a propeller, whose diameter it follows");
  int laws = 0;
  for (const char* law : {"kt_kq", "ct_cp", "wageningen"}) laws += propeller.contains(law);
  if (laws > 1)
    raiseInputError(
        place + "propeller", "has ", laws,
        " of kt_kq, ct_cp and wageningen; must be one of them, or none for an ideal disc");
  if (propeller.contains("area_ratio") && !propeller.contains("kt_kq") &&
      !propeller.contains("ct_cp"))
    raiseInputError(place + "propeller.area_ratio", "is given without a table kt_kq or ct_cp");
  for (const char* key : {"astern", "hand"})
    if (laws == 0 && propeller.contains(key))
      raiseInputError(place + "propeller." + key, "is given of an ideal disc, which has no blades");
  try {
    thruster.propeller = toPropeller(propeller);
  } catch (const std::invalid_argument& error) {
    raiseInputError(place + "propeller", error.what());
  }
  if (!thruster.propeller->isIdealDisc() && from.contains("torque_per_thrust"))
    raiseInputError(place + "torque_per_thrust", "is given beside a propeller that has a torque");
  thruster.radius = thruster.propeller->diameter() / 2;
  thruster.is_left_handed = propeller.value("hand", "right") == "left";
  thruster.washes_bodies = propeller.value("washes_bodies", false);
}

}  // namespace

double valueAt(const CommandCurve& curve, double command) {
  if (!(command > curve.front().first)) return curve.front().second;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const auto& [from, low] = curve[i - 1];
    const auto& [to, high] = curve[i];
    if (command < to) return low + (high - low) * ((command - from) / (to - from));
  }
  return curve.back().second;
}

FoilDef toFoil(const nlohmann::json& from, const Scene& scene) {
  const std::string place =
      scene.file.string() + ": foils[" + std::to_string(scene.foils.size()) + "].";
  FoilDef def;
  const Mount mount = readPlace(from, scene, place, scene.foils, "foil_", def);
  Foil& foil = def.foil;
  foil.position = mount.pose * vectorOr(from, "position", foil.position);
  foil.chord_axis = mount.pose.linear() * vectorOr(from, "chord_axis", foil.chord_axis);
  foil.span_axis = mount.pose.linear() * vectorOr(from, "span_axis", foil.span_axis);
  foil.span = from.at("span").get<double>();
  foil.chord = from.at("chord").get<double>();
  foil.thickness = from.value("thickness", foil.thickness);
  foil.camber = from.value("camber", foil.camber);
  foil.drag = from.value("drag", foil.drag);
  foil.aspect = from.value("aspect", foil.aspect);
  if (from.contains("polar"))
    for (const auto& row : from.at("polar"))
      foil.polar.push_back({row[0].get<double>(), row[1].get<double>(), row[2].get<double>()});
  if (from.contains("curve")) def.curve = toCurve(from.at("curve"), place);
  def.command = from.value("command", def.command);
  def.lag = from.value("lag", def.lag);
  try {
    Foils({foil});
  } catch (const std::invalid_argument& error) {
    const std::string line = error.what();  // foil 0: its ...
    raiseInputError(place.substr(0, place.size() - 1), line.substr(line.find("its")));
  }
  return def;
}

ThrusterDef toThruster(const nlohmann::json& from, const Scene& scene) {
  const std::string place =
      scene.file.string() + ": thrusters[" + std::to_string(scene.thrusters.size()) + "].";
  ThrusterDef thruster;
  const Mount mount = readPlace(from, scene, place, scene.thrusters, "thruster_", thruster);
  thruster.position = mount.pose * vectorOr(from, "position", Vector3::Zero());
  const Vector3 axis = vectorOr(from, "axis", Vector3::UnitX());
  if (!(axis.norm() > 0)) raiseInputError(place + "axis", "is 0, 0, 0; must have a length > 0");
  thruster.axis = mount.pose.linear() * axis.normalized();
  thruster.curve = toCurve(from.at("curve"), place);
  thruster.command = from.value("command", thruster.command);
  thruster.lag = from.value("lag", thruster.lag);
  thruster.radius = from.value("radius", thruster.radius);
  thruster.torque_per_thrust = from.value("torque_per_thrust", thruster.torque_per_thrust);
  if (from.contains("propeller")) readPropeller(from, place, thruster);
  return thruster;
}

}  // namespace ambient
