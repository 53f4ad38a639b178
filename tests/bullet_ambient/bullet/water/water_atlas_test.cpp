#include "tests/bullet_ambient/bullet/water/water_atlas.h"

#include <gtest/gtest.h>

#include "tests/support/runs.h"

namespace ambient::test {
namespace {

TEST(WaterAtlas, FreeBodiesGainRoundingAtMost) {
  for (unsigned seed = 0; seed < runsOf(40); ++seed) {
    const WaterResult result = runWater({WaterSetting::kFree, Around::kWater, seed});
    EXPECT_TRUE(result.is_finite) << "seed " << seed;
    EXPECT_LT(result.over_earlier, byPrecision(1e-12, 1e-5)) << "seed " << seed;
  }
}

// Contacts and joints do work: docs/water.md has the share of 600 runs above 1 %. These 20 runs are
// held to it; without eq. (68a) three of those on joints to the world exceed it.
TEST(WaterAtlas, ContactsAndJointsRaiseTheEnergyOfFew) {
  struct Case {
    WaterSetting setting;
    int most;
  };
  for (const auto& [setting, most] :
       {Case{WaterSetting::kOnFloor, 5}, Case{WaterSetting::kAtWall, 1},
        Case{WaterSetting::kColliding, 0}, Case{WaterSetting::kJoined, 0},
        Case{WaterSetting::kTethered, 0}, Case{WaterSetting::kPile, 0},
        Case{WaterSetting::kTabled, 0}, Case{WaterSetting::kSteep, 0}}) {
    WaterTally tally;
    for (unsigned seed = 0; seed < runsOf(20); ++seed)
      tally.add(runWater({setting, Around::kWater, seed}));
    EXPECT_EQ(tally.not_finite, 0) << nameOf(setting);
    EXPECT_LE(tally.rose_much, most) << nameOf(setting);
  }
}

}  // namespace
}  // namespace ambient::test
