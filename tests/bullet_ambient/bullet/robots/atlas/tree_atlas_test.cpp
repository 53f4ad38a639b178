#include "tests/bullet_ambient/bullet/robots/atlas/tree_atlas.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/runs.h"

namespace ambient::test {
namespace {

constexpr double kRounding = kDouble ? 1e-12 : 1e-4;

std::vector<TreeResult> resultsOf(TreeSetting setting, TreeFluid fluid) {
  std::vector<TreeResult> results;
  const unsigned runs = setting == TreeSetting::kLong ? 6 : 24;
  for (unsigned seed = 0; seed < runsOf(runs); ++seed) {
    results.push_back(runTree({setting, fluid, seed}));
    EXPECT_TRUE(results.back().is_finite) << nameOf(setting) << ", seed " << seed;
  }
  return results;
}

// Results of tree_atlas_study: 0 in water, 2e-14 in ideal fluid; 2e-9 with 100 links.
TEST(TreeAtlas, FreeGainsRoundingAtMost) {
  for (const TreeFluid fluid : {TreeFluid::kWater, TreeFluid::kIdeal}) {
    for (const TreeResult& result : resultsOf(TreeSetting::kFree, fluid))
      EXPECT_LT(result.over_earlier, kRounding);
    for (const TreeResult& result : resultsOf(TreeSetting::kLong, fluid))
      EXPECT_LT(result.over_earlier, byPrecision(1e-8, 1e-2));
  }
}

// Walls and tether correct gaps, which can return energy lost in earlier turns. So energy may rise
// above an earlier value, in tree_atlas_study by 0.25 at most. It must stay below the initial
// value.
TEST(TreeAtlas, HeldGainsNothingOverItsStart) {
  for (const TreeSetting setting :
       {TreeSetting::kTethered, TreeSetting::kInBox, TreeSetting::kTetheredInBox})
    for (const TreeFluid fluid : {TreeFluid::kWater, TreeFluid::kIdeal})
      for (const TreeResult& result : resultsOf(setting, fluid)) {
        EXPECT_LT(result.over_start, kRounding) << nameOf(setting);
        EXPECT_LT(result.over_earlier, 0.3) << nameOf(setting);
      }
}

TEST(TreeAtlas, ThroughASurfaceGainsRoundingAtMost) {
  for (const TreeResult& result : resultsOf(TreeSetting::kThroughSurface, TreeFluid::kWater))
    EXPECT_LT(result.over_earlier, byPrecision(1e-11, 1e-3));
}

// Without a bound on the energy, and steps that are flown again, steps of 1/5 to 1/40 s raise it by
// up to 0.5. Trees that reach the surface within a step that began away from it still gain some.
TEST(TreeAtlas, InLongStepsThroughASurfaceGainsLittle) {
  for (const TreeResult& result : resultsOf(TreeSetting::kInLongSteps, TreeFluid::kWater))
    EXPECT_LT(result.over_earlier, 0.01);
}

// With the buoyancy of the start of a step these rise by 6e-5 to 4e-4.
TEST(TreeAtlas, BrakedThroughASurfaceGainsNothing) {
  if (!kDouble) return;  // float: different trees
  for (const unsigned seed : {1014u, 1028u, 1119u, 1216u})
    EXPECT_LT(runTree({TreeSetting::kBraked, TreeFluid::kWater, seed}).over_earlier, 1e-6) << seed;
}

// Ball joints beyond Bullet's limit of turns, an eighth of a revolution per step.
TEST(TreeAtlas, FastBallJointsGainRoundingAtMost) {
  if (!kDouble) return;  // float: different trees
  for (const unsigned seed : {1019u, 1237u, 1270u})
    EXPECT_LT(runTree({TreeSetting::kFree, TreeFluid::kIdeal, seed}).over_earlier, 1e-12) << seed;
}

}  // namespace
}  // namespace ambient::test
