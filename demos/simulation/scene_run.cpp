#include "demos/simulation/scene_run.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "demos/simulation/motion_recorder.h"

namespace ambient {

std::vector<double> outputTimes(const Scene& scene) {
  return timesOf(0, scene.duration, scene.output_step);
}

long long countSteps(double duration, double time_step) {
  constexpr double kRounding = 1e-9;  // of decimal numbers
  return static_cast<long long>(std::ceil(duration / time_step * (1 - kRounding)));
}

RunRecord runScene(const Scene& scene, const std::vector<PreparedBody>& bodies,
                   const RunProgress& progress) {
  using Clock = std::chrono::steady_clock;
  RunRecord record;
  record.steps = countSteps(scene.duration, scene.time_step);
  Simulation simulation(scene, bodies);
  MotionRecorder recorder(outputTimes(scene), scene.time_step);
  recorder.add(simulation.sample());
  Clock::duration stepping{};
  for (long long i = 0; i < record.steps; ++i) {
    const auto start = Clock::now();
    simulation.step();
    stepping += Clock::now() - start;
    recorder.add(simulation.sample());
    if (!progress(static_cast<double>(i + 1) / static_cast<double>(record.steps)))
      throw RunStopped();
  }
  record.wall_seconds = std::chrono::duration<double>(stepping).count();
  record.motion = std::move(recorder.motion());
  for (std::size_t i = 0; i < bodies.size(); ++i) record.work.push_back(simulation.work(i));
  record.warning = simulation.warning();
  return record;
}

}  // namespace ambient
