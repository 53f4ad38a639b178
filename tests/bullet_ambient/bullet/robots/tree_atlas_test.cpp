#include "tests/bullet_ambient/bullet/robots/tree_atlas.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"

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

// tree_atlas_study: nothing in water, 2e-14 in ideal fluid; 2e-9 of 100 links.
TEST(TreeAtlas, FreeGainsRoundingAtMost) {
  for (const TreeFluid fluid : {TreeFluid::kWater, TreeFluid::kIdeal}) {
    for (const TreeResult& result : resultsOf(TreeSetting::kFree, fluid))
      EXPECT_LT(result.over_earlier, kRounding);
    for (const TreeResult& result : resultsOf(TreeSetting::kLong, fluid))
      EXPECT_LT(result.over_earlier, byPrecision(1e-8, 1e-2));
  }
}

// Walls and the tether correct gaps, and so give back some of what turns have lost before: energy
// rises above an earlier value, in tree_atlas_study by 0.25 at most, and not above that of the
// start.
TEST(TreeAtlas, HeldGainsNothingOverItsStart) {
  for (const TreeSetting setting :
       {TreeSetting::kTethered, TreeSetting::kInBox, TreeSetting::kTetheredInBox})
    for (const TreeFluid fluid : {TreeFluid::kWater, TreeFluid::kIdeal})
      for (const TreeResult& result : resultsOf(setting, fluid)) {
        EXPECT_LT(result.over_start, kRounding) << nameOf(setting);
        EXPECT_LT(result.over_earlier, 0.3) << nameOf(setting);
      }
}

// docs/robots.md has how far the energy rises.
TEST(TreeAtlas, ThroughASurfaceStaysFinite) {
  EXPECT_EQ(resultsOf(TreeSetting::kThroughSurface, TreeFluid::kWater).size(), kSeeds);
}

// Ball joints that Bullet turns by less than they want, an eighth of a revolution in a step.
TEST(TreeAtlas, FastBallJointsGainRoundingAtMost) {
  if (!kDouble) return;  // other trees
  for (const unsigned seed : {1019u, 1237u, 1270u})
    EXPECT_LT(runTree({TreeSetting::kFree, TreeFluid::kIdeal, seed}).over_earlier, 1e-12) << seed;
}

}  // namespace
}  // namespace ambient::test
