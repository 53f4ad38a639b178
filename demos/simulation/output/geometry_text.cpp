#include "demos/simulation/output/geometry_text.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/base/plain_text.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using RoundedJson = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool,
                                         std::int64_t, std::uint64_t, float>;

RoundedJson toRoundedJson(const Vector3& v) {
  const Eigen::Vector3f rounded = v.cast<float>();
  return {rounded.x(), rounded.y(), rounded.z()};
}

bool hasTwoSides(const BodyDef& def, const PreparedBody& prepared) {
  return prepared.fluid_body ? prepared.fluid_body->volume == 0 : isSheet(def.shape);
}

/// The law of the body's pressure: balls have the published one.
PressureLaw lawOf(const BodyDef& def, const PreparedBody& prepared) {
  const bool is_ball = prepared.fluid_body && prepared.fluid_body->sphere_radius > 0;
  return is_ball ? PressureLaw::kPublished : def.attach.flow.law;
}

RoundedJson toRoundedJson(const BodyDef& def, const PreparedBody& prepared) {
  const Surface surface = moved(prepared.surface, -prepared.centre_of_mass);
  return {{"name", def.name},
          {"mass", static_cast<float>(prepared.mass)},
          {"law", wordOf(kPressureLawNames, lawOf(def, prepared))},
          {"separation_angle", static_cast<float>(def.attach.flow.separation_angle)},
          {"sheet", hasTwoSides(def, prepared)},
          {"vertices", std::vector<float>(surface.vertices.begin(), surface.vertices.end())},
          {"triangles", surface.triangles}};
}

RoundedJson toRoundedJson(const JointDef& joint) {
  RoundedJson text = {{"bodies", joint.bodies}, {"point", toRoundedJson(joint.point)}};
  if (joint.axis) text["axis"] = toRoundedJson(*joint.axis);
  return text;
}

RoundedJson cornerJson(const Vector3& corner) {
  RoundedJson text = RoundedJson::array();
  for (const double side : corner)
    text.push_back(std::isfinite(side) ? RoundedJson(static_cast<float>(side)) : RoundedJson());
  return text;
}

RoundedJson toRoundedJson(const WaterDef& water) {
  RoundedJson text = {{"level", static_cast<float>(water.sea.level)},
                      {"current", toRoundedJson(water.sea.current)},
                      {"waves", RoundedJson::array()}};
  const Vector3 up = water.sea.up.normalized();
  for (const WaveComponent& wave : water.waves) {
    const double frequency = 2 * kPi / wave.period;
    const Vector3 along = wave.direction - up.dot(wave.direction) * up;
    text["waves"].push_back(
        {{"amplitude", static_cast<float>(wave.amplitude)},
         {"frequency", static_cast<float>(frequency)},
         {"wave_number", static_cast<float>(frequency * frequency / water.sea.gravity)},
         {"direction", toRoundedJson(Vector3(along.normalized()))},
         {"phase", static_cast<float>(wave.phase)}});
  }
  if (water.bounds) {
    text["bounds"] = {{"lowest", cornerJson(water.bounds->lowest)},
                      {"highest", cornerJson(water.bounds->highest)}};
  }
  return text;
}

}  // namespace

std::string makeGeometryText(const Scene& scene, const std::vector<PreparedBody>& bodies) {
  RoundedJson geometry = {{"scene", scene.name},
                          {"medium_velocity", toRoundedJson(scene.medium.velocity)},
                          {"bodies", RoundedJson::array()},
                          {"joints", RoundedJson::array()},
                          {"water", scene.water ? toRoundedJson(*scene.water) : RoundedJson()}};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    geometry["bodies"].push_back(toRoundedJson(scene.bodies[i], bodies[i]));
  for (const JointDef& joint : scene.joints) geometry["joints"].push_back(toRoundedJson(joint));
  return geometry.dump() + "\n";
}

}  // namespace ambient
