// Light bodies on the ground: the scenes leaves and cards_in_wind.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/demos/simulation/scenes/run_scene.h"

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
  const std::string velocity =
      "[" + std::to_string(wind) + ", 0, " + std::to_string(0.0001 * wind) + "]";
  const Scene scene = readNamedScene("cards_in_wind", {{"medium.velocity", velocity}});
  const RunRecord record = runSharing(scene);
  const Vector3 table = std::get<Box>(scene.bodies[0].shape.geometry).half_sizes;
  // A card that lands on its edge sinks into the table for a moment, by less than its thickness: of
  // 480 runs at other winds 12 have a card below half of it in one sample, none below all of it.
  const double sunk = 2 * std::get<Box>(scene.bodies[1].shape.geometry).half_sizes.z();
  std::vector<double> carried;
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    const auto& motion = record.motion[i];
    carried.push_back((motion.back().position - motion.front().position).norm());
    for (const MotionSample& sample : motion) {
      const bool is_over_table = (sample.position.cwiseAbs() - table).head<2>().maxCoeff() < 0;
      EXPECT_TRUE(sample.position.z() > -sunk || !is_over_table);
    }
  }
  EXPECT_EQ(carried.size(), 3u);
  return carried;
}

/// In which 1/2 rho V^2 on one side of a card is its weight [m/s].
double liftingWind() {
  const Scene scene = readNamedScene("cards_in_wind");
  const BodyDef& card = scene.bodies[1];
  const Vector3 half = std::get<Box>(card.shape.geometry).half_sizes;
  const double area = 4 * half.x() * half.y();
  return std::sqrt(2 * card.mass * -scene.gravity.z() / (scene.medium.density * area));
}

// Close to that pressure their grip is less than what drags them along.
TEST(CardsInWind, LieStillWhileTheirWeightWellExceedsTheDynamicPressure) {
  for (const double part : {0.0, 0.5, 0.8})
    for (const double way : carriedBy(part * liftingWind())) EXPECT_LT(way, 0.003) << part;
}

// The wind rises a little, so that it meets the lower side of a card that lies flat. Below 1.3, the
// way of a card changes from 0.1 m to 1 m with the fourth digit of the wind.
TEST(CardsInWind, AreCarriedOffOnceItExceedsTheirWeight) {
  for (const double part : {1.2, 1.3, 1.5, 1.7, 2.0}) {
    const std::vector<double> ways = carriedBy(part * liftingWind());
    EXPECT_GT(*std::max_element(ways.begin(), ways.end()), part < 1.3 ? 0.03 : 0.5) << part;
  }
}

TEST(CardsInWind, AllLeaveTheirPlaceInTheWindOfTheScene) {
  for (const double way : carriedBy(readNamedScene("cards_in_wind").medium.velocity.x()))
    EXPECT_GT(way, 0.5);
}

}  // namespace
}  // namespace ambient
