#include "demos/simulation/summary.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/spatial/principal_frame.h"
#include "demos/analysis/falling_mode.h"
#include "demos/analysis/path_summary.h"

namespace ambient {
namespace {

using json = nlohmann::ordered_json;

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
