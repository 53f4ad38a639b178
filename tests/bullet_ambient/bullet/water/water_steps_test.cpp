#include "tests/bullet_ambient/bullet/water/water_steps.h"

#include <gtest/gtest.h>

#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

// Results of water_steps_study: order 2.2, error 4e-3 at 1/30 s.
TEST(WaterSteps, HeaveOfABallConvergesWithOrderTwo) {
  const StepErrors errors = measureSteps(WaterMotion::kHeave, 0);
  EXPECT_LT(errors.deviations[0], 0.006);
  EXPECT_GT(errors.order, byPrecision(1.8, 1.2));
}

// Single step: impact falls at an unknown part of the step, hence order 1.
TEST(WaterSteps, EntryConvergesWithOrderOneAndSubstepsMakeLongStepsGood) {
  const StepErrors single = measureSteps(WaterMotion::kEntry, 1);
  EXPECT_GT(single.order, 0.6);
  EXPECT_GT(single.deviations[0], 0.1);
  for (const double deviation : measureSteps(WaterMotion::kEntry, 0).deviations)
    EXPECT_LT(deviation, 0.03);
}

}  // namespace
}  // namespace ambient::test
