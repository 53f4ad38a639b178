#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {
namespace {

/// Number of steps of equal error, `most` at most, before add() reports a large sum.
int stepsBeforeLarge(double error, int most) {
  StepErrors errors;
  for (int i = 0; i < most; ++i)
    if (errors.add(error)) return i;
  return most;
}

TEST(StepErrors, OneLargeStepIsTooMuch) {
  EXPECT_EQ(stepsBeforeLarge(1.01 * StepErrors::kLargest, 10), 0);
  EXPECT_EQ(stepsBeforeLarge(0.99 * StepErrors::kLargest, 10), 1);
}

// Sum of equal errors tends to sqrt(64) times one error.
TEST(StepErrors, SmallOnesAddUpToEightTimesOne) {
  EXPECT_LT(stepsBeforeLarge(1.01 / 8 * StepErrors::kLargest, 10000), 500);
  EXPECT_EQ(stepsBeforeLarge(0.99 / 8 * StepErrors::kLargest, 10000), 10000);
}

TEST(StepErrors, AreForgotten) {
  StepErrors errors;
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(errors.add(0.8 * StepErrors::kLargest)) << i;
    for (int calm = 0; calm < 256; ++calm) errors.add(0);
  }
}

TEST(StepErrors, AreToldOnce) {
  StepErrors errors;
  EXPECT_TRUE(errors.add(1));
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(errors.add(i % 2));
}

TEST(StepErrors, AreReportedOfOneBodyAndCountedOfAll) {
  FluidWorld scene;
  std::vector<std::string> said;
  scene.fluid.setReport([&](const std::string& text) { said.push_back(text); });
  const Vector3 semi_axes(0.05, 0.05, 0.01);
  BodyDef def{2e-4, ellipsoidMoments(semi_axes, 2e-4), {}, nullptr};
  def.start.twist = {Vector3(100, 50, 20), Vector3(300, 0, 200)};
  FluidBody shape = meshedEllipsoid(semi_axes, 2);
  for (const char* name : {"feather", "flake"}) {
    shape.name = name;
    scene.add(def, shape, air());
  }
  scene.step(1.0 / 60, 60);
  ASSERT_EQ(said.size(), 1u);
  const bool names_one = said[0].find("'feather'") != std::string::npos ||
                         said[0].find("'flake'") != std::string::npos;
  EXPECT_TRUE(names_one) << said[0];
  EXPECT_NE(said[0].find("take shorter steps"), std::string::npos) << said[0];
  EXPECT_EQ(scene.fluid.counters().too_long, 2);
}

}  // namespace
}  // namespace ambient::test
