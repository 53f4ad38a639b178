#pragma once

#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/output_file.h"
#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"
#include "demos/simulation/simulation.h"

namespace ambient {

/// What came of a run, besides its trajectory file.
struct RunRecord {
  long long steps = 0;
  double wall_seconds = 0;                        ///< spent stepping
  std::vector<std::vector<MotionSample>> motion;  ///< per body, one sample per output time
  std::vector<FlightWork> work;                   ///< per body
  std::string warning;                            ///< of the library, one sentence; mostly empty
};

/// The times of the rows: multiples of the output step from 0 on, and the duration.
std::vector<double> outputTimes(const Scene& scene);

/// Steps that cover the duration.
long long countSteps(const Scene& scene);

/// Runs a scene and writes trajectory.csv into `file`, which stays uncommitted.
/// Output times between two steps are interpolated.
/// @throws std::runtime_error naming body and time if a state is not finite, or if interrupted.
RunRecord runScene(const Scene& scene, const std::vector<PreparedBody>& bodies, OutputFile& file,
                   bool quiet);

/// Makes a running runScene() stop with an exception; may be called from a signal handler.
void interruptRun() noexcept;

}  // namespace ambient
