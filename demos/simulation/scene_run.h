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

/// Further columns of trajectory.csv: what the fluid does to a body.
struct FluidLog {
  bool wrench = false;  ///< wrenches by part in the step that ends at the row's time, or after it
  bool wet = false;     ///< what is wet of the body after that step
  bool holds = false;   ///< the water in its holds then

  bool isEmpty() const { return !wrench && !wet && !holds; }
};

/// Text of a number with 17 significant digits.
std::string digits17(double value);

/// Reads words of "wrench", "wet", "holds" with commas between them.
/// @throws std::invalid_argument naming a word that is none of these.
FluidLog parseFluidLog(const std::string& words);

/// Names of the columns, each after a comma; for as many holds as the body with most of them has.
std::string fluidLogHeader(const FluidLog& log, const std::vector<PreparedBody>& bodies);

/// Results of a run.
struct RunRecord {
  long long steps = 0;
  double wall_seconds = 0;                        ///< wall-clock time of all steps [s]
  std::vector<std::vector<MotionSample>> motion;  ///< [body][output time]
  std::vector<std::vector<std::string>> log;      ///< fluidLogRow() likewise; empty: not asked for
  std::vector<AmbientCounters> work;              ///< one entry per body
  std::string warning;                            ///< last report of the library; empty: none
};

/// Called after each step with the finished share of the run, 0 to 1; false stops the run.
using RunProgress = std::function<bool(double share)>;

/// Thrown if a run was told to stop.
struct RunStopped : std::runtime_error {
  RunStopped() : std::runtime_error("interrupted") {}
};

/// Output times [s]: multiples of the output step from 0 on, and the duration.
std::vector<double> outputTimes(const Scene& scene);

/// Number of steps needed to cover a duration [s].
long long countSteps(double duration, double time_step);

/// Runs a scene. Output times between two steps are interpolated.
/// @throws std::runtime_error naming body and time if a state is not finite; RunStopped.
RunRecord runScene(
    const Scene& scene, const std::vector<PreparedBody>& bodies,
    const RunProgress& progress = [](double) { return true; }, const FluidLog& log = {});

}  // namespace ambient
