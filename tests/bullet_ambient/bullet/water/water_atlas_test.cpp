#include "tests/bullet_ambient/bullet/water/water_atlas.h"

#include <gtest/gtest.h>

namespace ambient::test {
namespace {

TEST(WaterAtlas, FreeBodiesGainRoundingAtMost) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const WaterResult result = runWater({WaterSetting::kFree, Around::kWater, seed});
    EXPECT_TRUE(result.is_finite) << "seed " << seed;
    EXPECT_LT(result.over_earlier, byPrecision(1e-12, 1e-5)) << "seed " << seed;
  }
}

// Contacts and joints do work: docs/water.md has how many of 600 rise by more than 1 %, and how
// far. Of 20 no more do than three standard deviations above that share.
TEST(WaterAtlas, ContactsAndJointsRaiseTheEnergyOfAsFewAsInTheStudy) {
  struct Case {
    WaterSetting setting;
    int most;
  };
  for (const auto& [setting, most] :
       {Case{WaterSetting::kOnFloor, 6}, Case{WaterSetting::kAtWall, 1},
        Case{WaterSetting::kColliding, 1}, Case{WaterSetting::kJoined, 1},
        Case{WaterSetting::kTethered, 3}, Case{WaterSetting::kPile, 1},
        Case{WaterSetting::kTabled, 3}, Case{WaterSetting::kSteep, 0}}) {
    WaterTally tally;
    for (unsigned seed = 0; seed < 20; ++seed) tally.add(runWater({setting, Around::kWater, seed}));
    EXPECT_EQ(tally.not_finite, 0) << nameOf(setting);
    EXPECT_LE(tally.rose_much, most) << nameOf(setting);
  }
}

}  // namespace
}  // namespace ambient::test
