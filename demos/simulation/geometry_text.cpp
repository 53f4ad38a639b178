#include "demos/simulation/geometry_text.h"

#include <nlohmann/json.hpp>

#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using json = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool,
                                  std::int64_t, std::uint64_t, float>;

json toJson(const Vector3& v) {
  const Eigen::Vector3f rounded = v.cast<float>();
  return {rounded.x(), rounded.y(), rounded.z()};
}

bool hasTwoSides(const BodyDef& def, const PreparedBody& prepared) {
  return prepared.fluid_body ? prepared.fluid_body->volume == 0 : isSheet(def.shape);
}

json toJson(const BodyDef& def, const PreparedBody& prepared) {
  const Surface surface = moved(prepared.surface, -prepared.centre_of_mass);
  return {{"name", def.name},
          {"mass", static_cast<float>(prepared.mass)},
          {"separation_angle", static_cast<float>(def.flow.separation_angle)},
          {"sheet", hasTwoSides(def, prepared)},
          {"vertices", std::vector<float>(surface.vertices.begin(), surface.vertices.end())},
          {"triangles", surface.triangles}};
}

json toJson(const JointDef& joint) {
  json text = {{"bodies", joint.bodies}, {"point", toJson(joint.point)}};
  if (joint.axis) text["axis"] = toJson(*joint.axis);
  return text;
}

}  // namespace

std::string makeGeometryText(const Scene& scene, const std::vector<PreparedBody>& bodies) {
  json geometry = {{"scene", scene.name},
                   {"medium_velocity", toJson(scene.medium.velocity)},
                   {"bodies", json::array()},
                   {"joints", json::array()}};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    geometry["bodies"].push_back(toJson(scene.bodies[i], bodies[i]));
  for (const JointDef& joint : scene.joints) geometry["joints"].push_back(toJson(joint));
  return geometry.dump() + "\n";
}

}  // namespace ambient
