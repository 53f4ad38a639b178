// Light bodies on the ground: the scenes leaves and cards_in_wind.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/demos/simulation/run_scene.h"

namespace ambient {
namespace {

TEST(Leaves, SettleFlatOnTheFloor) {
  const Scene scene = readNamedScene("leaves");
  const RunRecord record = run(scene);
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    const MotionSample& end = record.motion[i].back();
    const std::string& name = scene.bodies[i].name;
    EXPECT_NEAR(end.position.z(), 0.004, 0.001) << name;
    EXPECT_GT(std::abs((end.orientation * Vector3::UnitZ()).z()), 0.99) << name;
    EXPECT_LT(end.twist.linear.norm(), 0.005) << name;
    for (const MotionSample& sample : record.motion[i]) EXPECT_GT(sample.position.z(), 0) << name;
  }
}

/// How far the wind has carried each card [m].
std::vector<double> carriedBy(double wind) {
  const Scene scene = readNamedScene("cards_in_wind",
                                     {{"medium.velocity", "[" + std::to_string(wind) + ", 0, 0]"}});
  const RunRecord record = runSharing(scene);
  std::vector<double> carried;
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    const auto& motion = record.motion[i];
    carried.push_back((motion.back().position - motion.front().position).norm());
    for (const MotionSample& sample : motion) EXPECT_GT(sample.position.z(), 0);
  }
  return carried;
}

TEST(CardsInWind, LieStillWhileTheirWeightExceedsTheDynamicPressure) {
  // 1/2 rho V^2 on one side lifts them from 2.3 m/s on.
  for (const double wind : {0.0, 1.0, 2.2})
    for (const double way : carriedBy(wind)) EXPECT_LT(way, 0.003) << wind << " m/s";
}

TEST(CardsInWind, AreCarriedOffByAStrongerWind) {
  for (const double way : carriedBy(4)) EXPECT_GT(way, 0.5);
}

}  // namespace
}  // namespace ambient
