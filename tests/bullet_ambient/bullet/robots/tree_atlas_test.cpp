#include "tests/bullet_ambient/bullet/robots/tree_atlas.h"

#include <gtest/gtest.h>

namespace ambient::test {
namespace {

constexpr unsigned kSeeds = 30;

// tree_atlas_study: none of 2000.
TEST(TreeAtlas, InWaterNeverGainsEnergy) {
  for (int setting = 0; setting < kTreeSettings; ++setting)
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      const TreeResult result =
          runTree({static_cast<TreeSetting>(setting), TreeFluid::kWater, seed});
      EXPECT_TRUE(result.is_finite) << setting << ", seed " << seed;
      EXPECT_LT(result.energy_rise, 1e-6) << setting << ", seed " << seed;
    }
}

// tree_atlas_study: 3e-14 at most in 2000.
TEST(TreeAtlas, InAnIdealFluidGainsRoundingAtMost) {
  for (const TreeSetting setting : {TreeSetting::kFree, TreeSetting::kTethered, TreeSetting::kInBox,
                                    TreeSetting::kTetheredInBox})
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      const TreeResult result = runTree({setting, TreeFluid::kIdeal, seed});
      EXPECT_TRUE(result.is_finite) << nameOf(setting) << ", seed " << seed;
      EXPECT_LT(result.energy_rise, kDouble ? 1e-12 : 1e-4) << nameOf(setting) << ", seed " << seed;
    }
}

// Ball joints that Bullet turns by less than they want, an eighth of a revolution in a step.
TEST(TreeAtlas, FastBallJointsGainRoundingAtMost) {
  if (!kDouble) return;  // other trees
  for (const unsigned seed : {1019u, 1237u, 1270u})
    EXPECT_LT(runTree({TreeSetting::kFree, TreeFluid::kIdeal, seed}).energy_rise, 1e-12) << seed;
}

}  // namespace
}  // namespace ambient::test
