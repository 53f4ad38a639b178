// Scenes at 60 Hz that look right must give no warning of long steps. Longer steps must be
// counted.

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

Scene sceneInSteps(const std::string& name, double step) {
  return readNamedScene(
      name, {{"time_step", std::to_string(step)}, {"duration", "2"}, {"output_step", "0.1"}});
}

RunRecord runAt60Hz(const std::string& name) { return runSharing(sceneInSteps(name, 1.0 / 60)); }

long long bodiesWithLongSteps(const RunRecord& record) {
  return std::accumulate(
      record.work.begin(), record.work.end(), 0LL,
      [](long long sum, const AmbientCounters& work) { return sum + work.too_long; });
}

TEST(LongSteps, AreNoneForFallingPlates) {
  for (const char* name : {"plate_8cm", "plate_9cm", "plate_10cm"})
    EXPECT_EQ(runAt60Hz(name).warning, "") << name;
}

TEST(LongSteps, AreNotToldWhereFewAreCoarse) {
  const RunRecord record = runAt60Hz("leaves");
  long long coarse = 0;
  for (const AmbientCounters& work : record.work) coarse += work.coarse;
  EXPECT_GT(coarse, 0);
  EXPECT_EQ(record.warning, "");
  EXPECT_EQ(bodiesWithLongSteps(record), 0);
}

TEST(LongSteps, AreToldOnceAndCountedOfEachBody) {
  Scene scene = sceneInSteps("leaves", 0.1);
  for (BodyDef& leaf : scene.bodies) leaf.attach.flow.law = PressureLaw::kPublished;
  const RunRecord record = runSharing(scene);
  EXPECT_NE(record.warning.find("the world's step is too long"), std::string::npos);
  EXPECT_GT(bodiesWithLongSteps(record), 1);
  EXPECT_LE(bodiesWithLongSteps(record), static_cast<long long>(scene.bodies.size()));
}

}  // namespace
}  // namespace ambient
