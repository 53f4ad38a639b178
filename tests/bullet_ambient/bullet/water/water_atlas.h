#pragma once

#include <array>

#include "tests/bullet_ambient/bullet/water/water_run.h"

namespace ambient::test {

/// What random bodies meet besides the surface of still water, or of waves.
enum class WaterSetting {
  kFree,
  kOnFloor,
  kAtWall,
  kColliding,  ///< two
  kJoined,     ///< two, by a ball joint or a hinge
  kTethered,   ///< by one of these to a point in the world
  kPile,       ///< eight that fall upon each other, above the water or in it
  kTabled,     ///< a ball, which has a waterline table, by a joint to a point in the world
  kSteep,      ///< two over a floor in waves of 0.9 of the steepness at which they would break
};
constexpr int kWaterSettings = 9;
const char* nameOf(WaterSetting setting);

/// Bodies of all shapes, 0.05 to 5 m, 0.02 to 20 times as dense as the water, by either law,
/// separating at pi/2 or pi; from above the surface or below it in any attitude, at up to three
/// times the speed of a fall by their size; steps of 1/30, 1/60, 1/240 or 1/960 s.
struct WaterCase {
  WaterSetting setting = WaterSetting::kFree;
  Around around = Around::kWater;
  unsigned seed = 0;  ///< of all the rest
};

constexpr double kWaterAtlasTime = 3;  ///< the longest; what has sunk by five sizes ends it [s]

constexpr double kAtlasHertz[] = {30, 60, 240, 960};
constexpr int kAtlasSteps = 4;

struct WaterResult {
  int step = 0;           ///< which of kAtlasHertz
  bool is_finite = true;  ///< and no result of a step was left out
  /// Of the energy, over the scale of WaterRun::energyScale(); 0 in waves, which do work.
  double over_earlier = 0;  ///< the largest rise above any earlier one
  double over_start = 0;    ///< above that of the start
};
WaterResult runWater(const WaterCase& water_case);

/// What became of many.
struct WaterTally {
  int runs = 0, not_finite = 0;
  int rose = 0, rose_much = 0;            ///< over any earlier one, by more than 1e-3, 1e-2
  double over_earlier[kAtlasSteps] = {};  ///< the largest, by steps
  double over_start = 0;                  ///< the largest

  void add(const WaterResult& result);
};

/// `runs` of each setting, in water and in a vacuum: [setting][around].
using WaterTable = std::array<std::array<WaterTally, 2>, kWaterSettings>;
WaterTable runWaters(int runs, unsigned seed);

}  // namespace ambient::test
