#include "demos/simulation/geometry_text.h"

#include <nlohmann/json.hpp>

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

RoundedJson toRoundedJson(const BodyDef& def, const PreparedBody& prepared) {
  const Surface surface = moved(prepared.surface, -prepared.centre_of_mass);
  return {{"name", def.name},
          {"mass", static_cast<float>(prepared.mass)},
          {"separation_angle", static_cast<float>(def.flow.separation_angle)},
          {"sheet", hasTwoSides(def, prepared)},
          {"vertices", std::vector<float>(surface.vertices.begin(), surface.vertices.end())},
          {"triangles", surface.triangles}};
}

RoundedJson toRoundedJson(const JointDef& joint) {
  RoundedJson text = {{"bodies", joint.bodies}, {"point", toRoundedJson(joint.point)}};
  if (joint.axis) text["axis"] = toRoundedJson(*joint.axis);
  return text;
}

}  // namespace

std::string makeGeometryText(const Scene& scene, const std::vector<PreparedBody>& bodies) {
  RoundedJson geometry = {{"scene", scene.name},
                          {"medium_velocity", toRoundedJson(scene.medium.velocity)},
                          {"bodies", RoundedJson::array()},
                          {"joints", RoundedJson::array()}};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    geometry["bodies"].push_back(toRoundedJson(scene.bodies[i], bodies[i]));
  for (const JointDef& joint : scene.joints) geometry["joints"].push_back(toRoundedJson(joint));
  return geometry.dump() + "\n";
}

}  // namespace ambient
