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

TEST(WaterAtlas, NoneHasMoreEnergyThanAtItsStart) {
  for (int setting = 0; setting < kWaterSettings; ++setting)
    for (unsigned seed = 0; seed < 20; ++seed) {
      const WaterResult result =
          runWater({static_cast<WaterSetting>(setting), Around::kWater, seed});
      EXPECT_TRUE(result.is_finite) << setting << ", seed " << seed;
      EXPECT_LT(result.over_start, byPrecision(1e-12, 1e-5)) << setting << ", seed " << seed;
    }
}

}  // namespace
}  // namespace ambient::test
