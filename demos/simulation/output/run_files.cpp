#include "demos/simulation/output/run_files.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "demos/analysis/path_summary.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const fs::path& folder)
    : folder_(fs::absolute(folder).lexically_normal()) {
  for (fs::path at = folder_; !at.empty() && !fs::exists(at); at = at.parent_path())
    if (at.has_filename()) made_.insert(made_.begin(), at);
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || !fs::is_directory(folder_)) {
    const std::string reason = error ? error.message() : "it is not a folder";
    throw std::runtime_error(folder.string() + ": cannot be made: " + reason);
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  // remove() fails for a folder that is not empty.
  std::for_each(made_.rbegin(), made_.rend(), [&](const fs::path& at) { fs::remove(at, ignored); });
}

namespace {

using json = nlohmann::ordered_json;
using RoundedJson = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool,
                                         std::int64_t, std::uint64_t, float>;

RoundedJson toRoundedJson(const Vector3& v) {
  const Eigen::Vector3f rounded = v.cast<float>();
  return {rounded.x(), rounded.y(), rounded.z()};
}

RoundedJson toRoundedJson(const Surface& surface) {
  return {{"vertices", std::vector<float>(surface.vertices.begin(), surface.vertices.end())},
          {"triangles", surface.triangles.get()}};
}

bool hasTwoSides(const BodyDef& def, const PreparedBody& prepared) {
  return prepared.fluid_body ? prepared.fluid_body->volume == 0 : isSheet(def.shape);
}

RoundedJson toRoundedJson(const BodyDef& def, const PreparedBody& prepared) {
  RoundedJson text = {{"name", def.name},
                      {"mass", static_cast<float>(prepared.mass)},
                      {"law", wordOf(kPressureLawNames, def.attach.flow.law)},
                      {"separation_angle", static_cast<float>(def.attach.flow.separation_angle)},
                      {"sheet", hasTwoSides(def, prepared)}};
  text.update(toRoundedJson(moved(prepared.surface, -prepared.centre_of_mass)));
  if (!prepared.fluid_body) return text;
  const Vector3 origin = prepared.fluid_origin - prepared.centre_of_mass;
  for (const Hold& hold : prepared.fluid_body->holds)
    text["holds"].push_back(toRoundedJson(moved(hold.surface, origin)));
  return text;
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

json toJson(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

json toJson(const MotionSample& sample) {
  const Quaternion& q = sample.orientation;
  return {{"time", sample.time},
          {"position", toJson(sample.position)},
          {"orientation", {q.w(), q.x(), q.y(), q.z()}},
          {"linear_velocity", toJson(sample.twist.linear)},
          {"angular_velocity", toJson(sample.twist.angular)}};
}

/// Normal of a plate in the shape's axes; none if the body is more than half as thick as wide. Its
/// thickness and width are root mean square extents of a uniform body along the principal axes.
std::optional<Vector3> plateNormal(const FluidBody& body) {
  const PrincipalFrame frame = findPrincipalFrame(body.uniform_mass.inertia);
  const Vector3 extents_squared =
      (Vector3::Constant(0.5 * frame.moments.sum()) - frame.moments).cwiseMax(0);
  Vector3::Index thin = 0;
  const double thickness_squared = extents_squared.minCoeff(&thin);
  const double width_squared =
      std::min(extents_squared[(thin + 1) % 3], extents_squared[(thin + 2) % 3]);
  constexpr double kFlat = 0.5;
  if (thickness_squared > kFlat * kFlat * width_squared) return std::nullopt;
  return Vector3(frame.rotation.col(thin));
}

json toJson(const Fall& fall) {
  json events = json::array();
  for (const FallEvent& event : fall.events)
    events.push_back({{"time", event.time}, {"kind", event.is_overturn ? "overturn" : "swing"}});
  return {{"mode", fallingModeName(fall.mode)},
          {"overturns", fall.overturns},
          {"swings", fall.swings},
          {"turns", fall.turns},
          {"largest_swing", fall.largest_swing},
          {"descent_speed", fall.descent_speed},
          {"drift_speed", fall.drift_speed},
          {"swing_axis", toJson(fall.swing_axis)},
          {"events", events}};
}

json toJson(const PathSummary& path) {
  json text = {{"length", path.length},
               {"largest_speed", path.largest_speed},
               {"largest_height", path.largest_height},
               {"descent_speed", path.descent_speed}};
  text["landing"] = path.landing ? toJson(*path.landing) : json();
  return text;
}

json toJson(const AmbientCounters& work) {
  json text;
  for (const auto& [name, count] : kWorkCounts) text[name] = work.*count;
  text["energy_removed"] = work.energy_removed;
  return text;
}

json toJson(const FluidBody& body) {
  return {{"name", body.name},          {"half_extents", toJson(extentsOf(body) / 2)},
          {"faces", body.faces.size()}, {"volume", body.volume},
          {"area", body.area},          {"settings", body.provenance.settings}};
}

}  // namespace

std::string trajectoryRow(const std::string& body, const MotionSample& sample) {
  const Vector3& p = sample.position;
  const Quaternion& q = sample.orientation;
  const Vector3& w = sample.twist.angular;
  const Vector3& v = sample.twist.linear;
  std::string row = digits17(sample.time) + "," + body;
  for (const double value :
       {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), w.x(), w.y(), w.z(), v.x(), v.y(), v.z()})
    row += "," + digits17(value);
  return row + "\n";
}

std::string makeTrajectoryText(const Scene& scene,
                               const std::vector<std::vector<MotionSample>>& motion,
                               const std::string& further_names,
                               const std::vector<std::vector<std::string>>& further) {
  std::string text = kTrajectoryHeader + further_names + "\n";
  for (std::size_t row = 0; row < motion.front().size(); ++row)
    for (std::size_t body = 0; body < motion.size(); ++body) {
      text += trajectoryRow(scene.bodies[body].name, motion[body][row]);
      if (!further.empty()) text.insert(text.size() - 1, further[body][row]);
    }
  return text;
}

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

std::string makeSummary(const Scene& scene, const std::vector<PreparedBody>& bodies,
                        const RunRecord& record) {
  json summary = {{"scene", scene.name},
                  {"description", scene.description},
                  {"model", wordOf(kFluidModelNames, scene.model)},
                  {"steps", record.steps},
                  {"time_step", scene.time_step},
                  {"duration", scene.duration},
                  {"output_step", scene.output_step},
                  {"integrator", wordOf(kIntegratorNames, scene.flight.own_flight)},
                  {"gravity", toJson(scene.gravity)},
                  {"wall_seconds_simulation", record.wall_seconds},
                  {"bodies", json::array()}};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::vector<MotionSample>& motion = record.motion[i];
    const std::shared_ptr<const FluidBody>& fluid_body = bodies[i].fluid_body;
    json body = {{"name", scene.bodies[i].name}, {"mass", bodies[i].mass}};
    body["fluid_body"] = fluid_body ? toJson(*fluid_body) : json();
    body["start"] = toJson(motion.front());
    body["end"] = toJson(motion.back());
    body["path"] = toJson(summarisePath(motion, scene.gravity));
    body["work"] = toJson(record.work[i]);
    const auto normal = fluid_body && bodies[i].mass > 0 && !scene.gravity.isZero()
                            ? plateNormal(*fluid_body)
                            : std::nullopt;
    body["fall"] = normal ? toJson(analyseFall(motion, *normal, scene.gravity)) : json();
    if (normal) body["plate_normal"] = toJson(*normal);
    summary["bodies"].push_back(body);
  }
  return summary.dump(2) + "\n";
}

}  // namespace ambient
