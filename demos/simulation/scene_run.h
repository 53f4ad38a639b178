#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/simulation.h"

namespace ambient {

/// What came of a run.
struct RunRecord {
  long long steps = 0;
  double wall_seconds = 0;                        ///< spent stepping
  std::vector<std::vector<MotionSample>> motion;  ///< per body, one sample per output time
  std::vector<FlightWork> work;                   ///< per body
  std::string warning;                            ///< of the library, one sentence; mostly empty
};

/// Is told after every step how much is done, from 0 to 1; the run goes on if it answers true.
using RunProgress = std::function<bool(double share)>;

/// A run was told to stop.
struct RunStopped : std::runtime_error {
  RunStopped() : std::runtime_error("interrupted") {}
};

/// The times of the rows: multiples of the output step from 0 on, and the duration.
std::vector<double> outputTimes(const Scene& scene);

/// Steps that cover a time [s].
long long countSteps(double duration, double time_step);

/// Runs a scene. Output times between two steps are interpolated.
/// @throws std::runtime_error naming body and time if a state is not finite; RunStopped.
RunRecord runScene(
    const Scene& scene, const std::vector<PreparedBody>& bodies,
    const RunProgress& progress = [](double) { return true; });

}  // namespace ambient
