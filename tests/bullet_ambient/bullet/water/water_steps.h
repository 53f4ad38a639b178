#pragma once

#include <vector>

namespace ambient::test {

/// Motions at the surface, used to measure convergence in the world's step.
enum class WaterMotion {
  kEntry,  ///< tilted cube of 0.5 m dropped by 1 m: depth and tilt after 0.8 s
  kExit,   ///< cube released at rest 1.5 m below: height and tilt after 0.9 s
  kHeave,  ///< ball of 0.3 m released from 30 mm: first four extremes
  kRoll,   ///< box of 1 m released from 5 degrees: first four extremes
  kWave,   ///< kRoll's box in a wave of 2 s: amplitude of heave
};
constexpr int kWaterMotions = 5;
const char* nameOf(WaterMotion motion);

/// Numbers of one run over their initial scale: a height of 1 m, the start of a decay, the wave's
/// amplitude; angles in radians. `max_substeps` as in FlightSettings.
std::vector<double> runMotion(WaterMotion motion, double step, int max_substeps);

/// Largest difference between numbers of a run and of a run at 1/7680 s.
struct StepErrors {
  std::vector<double> deviations;  ///< at 1/30, 1/60, 1/120 and 1/240 s
  double order = 0;                ///< mean order, from 1/30 to 1/240 s
};
StepErrors measureSteps(WaterMotion motion, int max_substeps);

}  // namespace ambient::test
