#pragma once

#include <string>
#include <vector>

#include "demos/simulation/simulation.h"

namespace ambient {

/// Integrator, step of the world and precision of loads for a run.
struct PrecisionMethod {
  std::string name;
  FlightSettings flight;
  double time_step = 0;  ///< step of the world, kPrecisionSample / integer [s]
  LoadPrecision precision = LoadPrecision::kSingle;
};

/// Interval between compared samples [s].
inline constexpr double kPrecisionSample = 1.0 / 30;

/// Motion and cost of one run.
struct PrecisionRun {
  std::vector<std::vector<MotionSample>> motion;  ///< per sample, per body
  bool finite = true;                             ///< false: the world broke down
  double processor_seconds = 0;                   ///< all steps, least of `takes`
  double load_evaluations = 0;                    ///< all bodies
  double coarse = 0;                              ///< body steps with an error above the tolerance
};

/// Runs the scene for its duration, `takes` times for the processor time.
/// @throws std::invalid_argument as Simulation.
PrecisionRun runWithMethod(Scene scene, const std::vector<PreparedBody>& bodies,
                           const PrecisionMethod& method, int takes);

/// Largest distances between two runs over all samples and bodies.
struct PrecisionError {
  double position = 0;  ///< [m]
  double angle = 0;     ///< [rad]
};

/// @pre both have as many samples; infinite if `run` is not finite.
PrecisionError errorOf(const PrecisionRun& run, const PrecisionRun& reference);

}  // namespace ambient
