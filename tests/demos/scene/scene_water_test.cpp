#include "demos/scene/scene_water.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/force/medium/waves.h"
#include "tests/demos/scene/scene_text.h"

namespace ambient {
namespace {

using nlohmann::json;

json seaScene() {
  json scene = ballScene();
  scene["gravity"] = {0, -4, 0};
  scene["water"] = json::parse(R"({"level": 0.5, "current": [1, 0, 0], "density": 1025,
    "waves": [{"amplitude": 0.1, "period": 2}, {"amplitude": 0, "period": 3, "direction": [0, 0, 1], "phase": 1}],
    "bounds": {"lowest": [null, -2, -3], "highest": [4, null, 5]}})");
  scene["regions"] =
      json::parse(R"([{"medium": {"density": 2, "velocity": [3, 0, 0]}, "priority": 4,
    "bounds": {"lowest": [0, 0, 0], "highest": [1, 1, 1]}}, {"medium": {"density": 7}}])");
  return scene;
}

TEST(SceneWater, TakesWaterOver) {
  const Scene scene = sceneFrom(seaScene());
  ASSERT_TRUE(scene.water);
  EXPECT_EQ(scene.water->sea.level, 0.5);
  EXPECT_EQ(scene.water->sea.up, Vector3(0, 4, 0));
  EXPECT_EQ(scene.water->sea.gravity, 4);
  EXPECT_EQ(scene.water->sea.current, Vector3(1, 0, 0));
  EXPECT_EQ(scene.water->medium.density, 1025);
  EXPECT_EQ(scene.water->medium.viscosity, water().viscosity);
  ASSERT_EQ(scene.water->waves.size(), 2u);
  EXPECT_EQ(scene.water->waves[0].amplitude, 0.1);
  EXPECT_EQ(scene.water->waves[0].direction, Vector3(1, 0, 0));
  EXPECT_EQ(scene.water->waves[1].direction, Vector3(0, 0, 1));
  EXPECT_EQ(scene.water->waves[1].phase, 1);
  ASSERT_TRUE(scene.water->bounds);
  EXPECT_EQ(scene.water->bounds->lowest, Vector3(-HUGE_VAL, -2, -3));
  EXPECT_EQ(scene.water->bounds->highest, Vector3(4, HUGE_VAL, 5));
}

TEST(SceneWater, MakesRegionsOfWaterFirst) {
  json text = seaScene();
  const std::vector<FluidRegion> regions = makeRegions(sceneFrom(text));
  ASSERT_EQ(regions.size(), 3u);
  EXPECT_EQ(regions[0].below.density, 1025);
  EXPECT_EQ(regions[0].above.value().density, 1.204);
  EXPECT_FALSE(regions[0].surface->isStill());
  // Deep water has the current of the waves, added once.
  EXPECT_NEAR(sampleRegion(regions[0], {0, -40, 0}, 0).here().velocity.x(), 1, 1e-12);
  EXPECT_EQ(regions[1].below.velocity.x(), 3);
  EXPECT_EQ(regions[1].priority, 4);
  EXPECT_TRUE(regions[1].bounds->hold({0.5, 0.5, 0.5}));
  EXPECT_FALSE(regions[2].bounds);
  text["water"].erase("waves");
  const FluidRegion still = makeRegions(sceneFrom(text))[0];
  EXPECT_TRUE(still.surface->isStill());
  EXPECT_EQ(sampleRegion(still, {0, 0, 0}, 0).here().velocity, Vector3(1, 0, 0));
  EXPECT_TRUE(sampleRegion(still, {0, 0.6, 0}, 0).isAbove());
}

TEST(SceneWater, AddsTheWavesOfASpectrum) {
  json text = seaScene();
  text["water"]["spectrum"] = json::parse(R"({"significant_height": 0.2, "peak_period": 3,
    "peak_enhancement": 1, "direction": [0, 0, 2], "components": 7, "seed": 5})");
  const std::vector<WaveComponent> waves = sceneFrom(text).water->waves;
  ASSERT_EQ(waves.size(), 9u);
  WaveSpectrum spectrum{0.2, 3, 1, {0, 0, 2}, 7, 5};
  const std::vector<WaveComponent> expected = wavesOf(spectrum);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(waves[i].amplitude, expected[i].amplitude);
    EXPECT_EQ(waves[i].period, expected[i].period);
    EXPECT_EQ(waves[i].direction, expected[i].direction);
    EXPECT_EQ(waves[i].phase, expected[i].phase);
  }
  EXPECT_EQ(waves[7].amplitude, 0.1);
  text["water"]["spectrum"] = {{"significant_height", 1}, {"peak_period", 8}};
  EXPECT_EQ(sceneFrom(text).water->waves[0].phase, wavesOf({1, 8})[0].phase);
}

TEST(SceneWater, SaysWhatIsWrongWithWaterAndRegions) { expectSceneRefusals("water", seaScene()); }

}  // namespace
}  // namespace ambient
