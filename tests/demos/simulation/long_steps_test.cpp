// Scenes at 60 Hz of which each is right to the eye: nothing is said of their steps.

#include <gtest/gtest.h>

#include <string>

#include "tests/demos/simulation/run_scene.h"

namespace ambient {
namespace {

RunRecord runAt60Hz(const std::string& name) {
  return runSharing(readNamedScene(
      name, {{"time_step", std::to_string(1.0 / 60)}, {"duration", "2"}, {"output_step", "0.1"}}));
}

TEST(LongSteps, AreNoneForFallingPlates) {
  for (const char* name : {"plate_8cm", "plate_9cm", "plate_10cm"})
    EXPECT_EQ(runAt60Hz(name).warning, "") << name;
}

TEST(LongSteps, AreNotToldWhereFewAreCoarse) {
  const RunRecord record = runAt60Hz("leaves");
  long long coarse = 0;
  for (const FlightWork& work : record.work) coarse += work.coarse;
  EXPECT_GT(coarse, 0);
  EXPECT_EQ(record.warning, "");
}

}  // namespace
}  // namespace ambient
