// Every scene of data/scenes, and the fluid bodies of their shapes.

#include <algorithm>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "demos/scene/scene_reader.h"
#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/golden/golden_record.h"

namespace ambient::test {
namespace {

void add(GoldenTrace& trace, const MotionSample& sample) {
  trace.add(sample.time);
  trace.add(sample.position);
  for (const double value : sample.orientation.coeffs()) trace.add(value);
  trace.add(sample.twist.angular);
  trace.add(sample.twist.linear);
}

// Caches bodies for all scenes and for both runs of each.
std::vector<PreparedBody> prepareOnce(const Scene& scene) {
  static SceneBodyCache cache;
  return prepareBodies(scene, cache);
}

// Records the first second of a scene.
GoldenRecord recordMotion(const std::filesystem::path& file) {
  const Scene scene = readScene(file, {{"duration", "1"}});
  const RunRecord run = runPrepared(scene, prepareOnce(scene));
  GoldenTrace trace;
  for (const std::vector<MotionSample>& body : run.motion)
    for (const MotionSample& sample : body) add(trace, sample);
  const auto moving = std::find_if(run.motion.begin(), run.motion.end(), [](const auto& body) {
    return !(body.front().position == body.back().position);
  });
  GoldenRecord record{"", trace.hash(), {}};
  const MotionSample& last = (moving == run.motion.end() ? run.motion.begin() : moving)->back();
  record.sample << last.position, last.twist.linear;
  return record;
}

GoldenRecord recordShapes(const std::filesystem::path& file) {
  GoldenTrace trace;
  GoldenRecord record;
  for (const PreparedBody& body : prepareOnce(readScene(file))) {
    if (!body.fluid_body) continue;
    trace.add(contentHash(*body.fluid_body));
    record.sample = body.fluid_body->added_mass.diagonal();
  }
  record.hash = trace.hash();
  return record;
}

}  // namespace

std::vector<GoldenRun> goldenRuns() {
  std::vector<GoldenRun> runs;
  for (const auto& file : listScenes({std::filesystem::path(AMBIENT_DATA) / "scenes"})) {
    runs.push_back({file.stem().string() + "_shapes", [file] { return recordShapes(file); }});
    runs.push_back({file.stem().string(), [file] { return recordMotion(file); }});
  }
  return runs;
}

}  // namespace ambient::test
