#include "tests/study/precision/precision_run.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>

#include "bullet_ambient/base/ambient_assert.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

double processorSeconds() {
  std::timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

PrecisionRun runOnce(const Scene& scene, const std::vector<PreparedBody>& bodies) {
  Simulation simulation(scene, bodies);
  PrecisionRun run;
  const auto samples = std::lround(scene.duration / kPrecisionSample);
  const auto steps = std::lround(kPrecisionSample / scene.time_step);
  try {
    for (long i = 0; i < samples; ++i) {
      const double begin = processorSeconds();
      for (long k = 0; k < steps; ++k) simulation.step();
      run.processor_seconds += processorSeconds() - begin;
      run.motion.push_back(simulation.sample());
    }
  } catch (const std::runtime_error&) {
    run.finite = false;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const AmbientCounters work = simulation.work(i);
    run.load_evaluations += static_cast<double>(work.load_evaluations);
    run.coarse += static_cast<double>(work.coarse);
  }
  return run;
}

}  // namespace

PrecisionRun runWithMethod(Scene scene, const std::vector<PreparedBody>& bodies,
                           const PrecisionMethod& method, int takes) {
  scene.flight = method.flight;
  scene.time_step = method.time_step;
  for (BodyDef& body : scene.bodies) body.attach.flow.precision = method.precision;
  PrecisionRun run = runOnce(scene, bodies);
  for (int i = 1; i < takes; ++i) {
    run.processor_seconds =
        std::min(run.processor_seconds, runOnce(scene, bodies).processor_seconds);
  }
  return run;
}

PrecisionError errorOf(const PrecisionRun& run, const PrecisionRun& reference) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!run.finite) return {kInfinity, kInfinity};
  AMBIENT_ASSERT(run.motion.size() == reference.motion.size());
  PrecisionError error;
  for (std::size_t i = 0; i < reference.motion.size(); ++i) {
    for (std::size_t body = 0; body < reference.motion[i].size(); ++body) {
      const MotionSample &a = run.motion[i][body], &b = reference.motion[i][body];
      error.position = std::max(error.position, (a.position - b.position).norm());
      error.angle = std::max(error.angle, angleBetween(a.orientation, b.orientation));
    }
  }
  return error;
}

}  // namespace ambient
