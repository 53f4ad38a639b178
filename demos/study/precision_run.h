#pragma once

#include <string>
#include <vector>

#include "demos/simulation/simulation.h"

namespace ambient {

/// One way to integrate a scene.
struct PrecisionMethod {
  std::string name;
  FlightSettings flight;
  double time_step = 0;  ///< of the world, a whole fraction of kPrecisionSample [s]
  LoadPrecision precision = LoadPrecision::kSingle;
};

/// Motions are compared at multiples of this time [s].
inline constexpr double kPrecisionSample = 1.0 / 30;

/// What one run came to.
struct PrecisionRun {
  std::vector<std::vector<MotionSample>> motion;  ///< per sample, per body
  bool finite = true;                             ///< the world did not break down on the way
  double processor_seconds = 0;                   ///< of all steps, least of several takes
  double load_evaluations = 0;                    ///< of all bodies
  double coarse = 0;                              ///< steps of bodies above the tolerance
};

/// Runs the scene for its duration, `takes` times for the processor time.
/// @throws std::invalid_argument as Simulation.
PrecisionRun runWithMethod(Scene scene, const std::vector<PreparedBody>& bodies,
                           const PrecisionMethod& method, int takes);

/// The largest distances of a run from another over all samples and bodies.
struct PrecisionError {
  double position = 0;  ///< [m]
  double angle = 0;     ///< [rad]
};

/// @pre both have as many samples; infinite if `run` is not finite.
PrecisionError errorOf(const PrecisionRun& run, const PrecisionRun& reference);

}  // namespace ambient
