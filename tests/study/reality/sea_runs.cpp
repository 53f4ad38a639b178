#include "tests/study/reality/sea_runs.h"

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "demos/scene/scene_reader.h"
#include "preprocess/shape/json_text.h"
#include "tests/study/reality/sea_measure.h"

namespace ambient {
namespace {

using nlohmann::json;

Scene sceneOf(const json& data, const std::string& name, const std::filesystem::path& file) {
  const json& found = data.at("cases").at(name);
  std::vector<SceneOverride> changes;
  if (found.contains("set"))
    for (const auto& [path, value] : found.at("set").items())
      changes.push_back({path, value.dump()});
  const json& scene = data.at("scenes").at(found.at("scene").get<std::string>());
  return parseScene(scene.dump(), file, changes);
}

}  // namespace

SeaRuns::SeaRuns(const std::filesystem::path& measurements)
    : file_(measurements), data_(parseJson(readBytes(measurements), measurements.string())) {}

const SeaRuns::Run& SeaRuns::run(const std::string& name) {
  const auto found = runs_.find(name);
  if (found != runs_.end()) return found->second;
  Run made;
  made.scene = sceneOf(data_, name, file_);
  made.bodies = prepareBodies(made.scene, bodies_);
  RunRecord record = runScene(made.scene, made.bodies);
  made.motion = std::move(record.motion.front());
  return runs_.emplace(name, std::move(made)).first->second;
}

double SeaRuns::valueOf(const json& measured, const Run& of) const {
  if (measured.at("of") == "added mass") {
    const int axis = 3 + measured.at("axis").get<int>();
    return of.scene.medium.density * of.bodies.front().fluid_body->added_mass(axis, axis);
  }
  const MotionMeasure what = readMotionMeasure(measured);
  return measure(what, seriesOf(what.along, of.motion, of.scene.gravity.norm()));
}

double SeaRuns::compute(const json& row) {
  try {
    return valueOf(row.at("measure"), run(row.at("case").get<std::string>()));
  } catch (const std::exception& error) {
    throw std::runtime_error(file_.string() + ": " + row.at("id").dump() + ": " + error.what());
  }
}

std::string SeaRuns::curves() {
  std::string table = "curve,time,value\n";
  const json& all = data_.at("series");
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Run& of = run(all[k].at("case").get<std::string>());
    const CoordinateSeries y =
        seriesOf(all[k].at("along").get<std::string>(), of.motion, of.scene.gravity.norm());
    const double balance = all[k].at("balance"), scale = all[k].at("scale");
    const double last = all[k].at("points").back().front();
    for (std::size_t i = 0; i < y.times.size() && y.times[i] <= 1.02 * last; ++i) {
      char line[96];
      std::snprintf(line, sizeof line, "%zu,%.6g,%.5g\n", k, y.times[i],
                    (y.values[i] - balance) / scale);
      table += line;
    }
  }
  return table;
}

}  // namespace ambient
