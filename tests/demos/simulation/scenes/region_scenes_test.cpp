// Scene with regions of fluid: wind_zone.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

TEST(WindZone, BlowsWhereItIsAndMoreTheLighterTheBall) {
  const Scene scene = readNamedScene("wind_zone");
  const RunRecord run = runSharing(scene);
  constexpr double kRadius = 0.02;
  double before = 1e9;
  for (std::size_t ball = 1; ball < scene.bodies.size(); ++ball) {
    double entry = 0, exit = 0;  // times
    const auto& motion = run.motion[ball];
    for (std::size_t i = 1; i < motion.size(); ++i) {
      const double height = motion[i - 1].position.z();
      if (entry == 0 && height < 4) entry = motion[i - 1].time;
      if (exit == 0 && height < 2 - kRadius) exit = motion[i - 1].time;  // all of it
      const double gain = motion[i].twist.linear.x() - motion[i - 1].twist.linear.x();
      if (height > 4.1) {
        EXPECT_EQ(gain, 0) << i;
      }
      if (height < 3.9 && height > 2.1) {
        EXPECT_GT(gain, 0) << i;
      }
      if (exit > 0) {
        // Air at rest slows the ball.
        EXPECT_LT(gain, 0) << i;
        break;
      }
      // Falling 1 m takes sqrt(2 / g): air has little effect.
      if (entry > 0) {
        EXPECT_NEAR(entry, std::sqrt(2 / 9.81), 0.02);
      }
    }
    ASSERT_GT(exit, entry);
    const double drift = motion.back().position.x();
    EXPECT_GT(drift, 0);
    EXPECT_LT(drift, before);
    before = drift;
  }
}

}  // namespace
}  // namespace ambient
