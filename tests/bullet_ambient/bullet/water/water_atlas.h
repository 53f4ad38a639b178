#pragma once

#include <array>
#include <vector>

#include "tests/bullet_ambient/bullet/water/water_run.h"

namespace ambient::test {

/// Surroundings of random bodies besides the surface of still water or waves.
enum class WaterSetting {
  kFree,
  kOnFloor,
  kAtWall,
  kColliding,  ///< two bodies
  kJoined,     ///< two bodies on a ball joint or a hinge
  kTethered,   ///< one body on such a joint to the world
  kPile,       ///< eight bodies that fall onto each other, above water or in it
  kTabled,     ///< a ball with a waterline table, on a joint to the world
  kSteep,      ///< two bodies over a floor, waves of 0.9 times breaking steepness
};
constexpr int kWaterSettings = 9;
const char* nameOf(WaterSetting setting);

/// Bodies of all shapes, 0.05 to 5 m, density 0.02 to 20 times water's, both laws, separation at
/// pi/2 or pi. Random attitude above or below the surface, up to three times the speed of a fall by
/// their size. Steps of 1/30, 1/60, 1/240 or 1/960 s.
struct WaterCase {
  WaterSetting setting = WaterSetting::kFree;
  Around around = Around::kWater;
  unsigned seed = 0;  ///< determines all other values
};

constexpr double kWaterAtlasTime = 3;  ///< longest; depth of five sizes ends it [s]

constexpr double kAtlasHertz[] = {30, 60, 240, 960};
constexpr int kAtlasSteps = 4;

struct WaterResult {
  int step = 0;           ///< index in kAtlasHertz
  bool is_finite = true;  ///< false: state not finite, or step rejected
  /// Rises of energy over WaterRun::energyScale(); 0 in waves, since waves do work.
  double over_earlier = 0;  ///< largest rise above any earlier value
  double over_start = 0;    ///< largest rise above the initial value
};
WaterResult runWater(const WaterCase& water_case);

/// Counts and extremes of many runs.
struct WaterTally {
  int runs = 0, not_finite = 0;
  int rose = 0, rose_much = 0;            ///< above an earlier value, by 1e-3, 1e-2
  double over_earlier[kAtlasSteps] = {};  ///< largest, by steps
  double over_start = 0;                  ///< largest

  void add(const WaterResult& result);
};

/// Results of `runs` cases of each setting, in water and in a vacuum: [setting][around].
using WaterTable = std::array<std::array<WaterTally, 2>, kWaterSettings>;
WaterTable runWaters(int runs, unsigned seed);

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
