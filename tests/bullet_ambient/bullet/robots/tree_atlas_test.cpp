#include "tests/bullet_ambient/bullet/robots/tree_atlas.h"

#include <gtest/gtest.h>

#include <vector>

namespace ambient::test {
namespace {

constexpr unsigned kSeeds = 30;
constexpr double kRounding = kDouble ? 1e-12 : 1e-4;

std::vector<TreeResult> resultsOf(TreeSetting setting, TreeFluid fluid) {
  std::vector<TreeResult> results;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    results.push_back(runTree({setting, fluid, seed}));
    EXPECT_TRUE(results.back().is_finite) << nameOf(setting) << ", seed " << seed;
  }
  return results;
}

// tree_atlas_study: none of 1000.
TEST(TreeAtlas, InWaterNeverGainsEnergy) {
  for (const TreeSetting setting : {TreeSetting::kFree, TreeSetting::kTethered, TreeSetting::kInBox,
                                    TreeSetting::kTetheredInBox, TreeSetting::kLong})
    for (const TreeResult& result : resultsOf(setting, TreeFluid::kWater))
      EXPECT_LT(result.over_earlier, kRounding) << nameOf(setting);
}

TEST(TreeAtlas, FreeInAnIdealFluidGainsRoundingAtMost) {
  for (const TreeSetting setting : {TreeSetting::kFree, TreeSetting::kLong})
    for (const TreeResult& result : resultsOf(setting, TreeFluid::kIdeal))
      EXPECT_LT(result.over_earlier, kRounding) << nameOf(setting);
}

// Walls and the tether give back what turns have lost before, and no more: energy rises above an
// earlier value, in tree_atlas_study by 0.06 at most, and not above that of the start.
TEST(TreeAtlas, HeldInAnIdealFluidGainsNothingOverItsStart) {
  for (const TreeSetting setting :
       {TreeSetting::kTethered, TreeSetting::kInBox, TreeSetting::kTetheredInBox})
    for (const TreeResult& result : resultsOf(setting, TreeFluid::kIdeal)) {
      EXPECT_LT(result.over_start, kRounding) << nameOf(setting);
      EXPECT_LT(result.over_earlier, 0.1) << nameOf(setting);
    }
}

// Ball joints that Bullet turns by less than they want, an eighth of a revolution in a step.
TEST(TreeAtlas, FastBallJointsGainRoundingAtMost) {
  if (!kDouble) return;  // other trees
  for (const unsigned seed : {1019u, 1237u, 1270u})
    EXPECT_LT(runTree({TreeSetting::kFree, TreeFluid::kIdeal, seed}).over_earlier, 1e-12) << seed;
}

}  // namespace
}  // namespace ambient::test
