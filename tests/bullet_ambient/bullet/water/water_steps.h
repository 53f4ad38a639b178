#pragma once

#include <vector>

namespace ambient::test {

/// Motions at the surface whose convergence in the world's step is measured.
enum class WaterMotion {
  kEntry,  ///< of a tilted cube of 0.5 m dropped by 1 m: depth and tilt after 0.8 s
  kExit,   ///< of the same from 1.5 m below, let go at rest: height and tilt after 0.9 s
  kHeave,  ///< decay of a ball of 0.3 m from 30 mm: the first four extremes
  kRoll,   ///< decay of a box of 1 m from 5 degrees: the first four extremes
  kWave,   ///< heave of that box in a wave of 2 s: the amplitude
};
constexpr int kWaterMotions = 5;
const char* nameOf(WaterMotion motion);

/// Numbers of one run, over those that the motion begins with: a height of 1 m, the start of a
/// decay, the amplitude of the wave; angles in radians. `max_substeps` as in FlightSettings.
std::vector<double> runMotion(WaterMotion motion, double step, int max_substeps);

/// How far a run is from one at 1/7680 s: the largest difference of its numbers.
struct StepErrors {
  std::vector<double> deviations;  ///< at 1/30, 1/60, 1/120 and 1/240 s
  double order = 0;                ///< mean, from 1/30 to 1/240 s
};
StepErrors measureSteps(WaterMotion motion, int max_substeps);

}  // namespace ambient::test
