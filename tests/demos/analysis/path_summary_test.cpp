#include "demos/analysis/path_summary.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ambient {
namespace {

/// A throw in a vacuum from the ground: 20 m/s along x, 10 m/s up.
std::vector<MotionSample> throwInVacuum(double g) {
  std::vector<MotionSample> samples;
  for (int i = 0; i <= 300; ++i) {
    MotionSample sample;
    sample.time = 0.01 * i;
    sample.position =
        Vector3(20 * sample.time, 0, 10 * sample.time - g / 2 * sample.time * sample.time);
    sample.twist.linear = Vector3(20, 0, 10 - g * sample.time);
    samples.push_back(sample);
  }
  return samples;
}

TEST(PathSummary, FindsWhereAThrowComesDown) {
  const double g = 9.81;
  const PathSummary path = summarisePath(throwInVacuum(g), Vector3(0, 0, -g));
  ASSERT_TRUE(path.landing);
  // A chord replaces an arc of 0.01 s: off by at most g (0.01 s)^2 / 8 in height.
  EXPECT_NEAR(path.landing->time, 2 * 10 / g, g * 1e-4 / 8 / 10);
  EXPECT_NEAR(path.landing->position.x(), 20 * 2 * 10 / g, 20 * g * 1e-4 / 8 / 10);
  EXPECT_NEAR(path.landing->position.z(), 0, 1e-12);
  EXPECT_NEAR(path.largest_height, 10 * 10 / (2 * g), g / 2 * 0.005 * 0.005);
  EXPECT_DOUBLE_EQ(path.largest_speed, throwInVacuum(g).back().twist.linear.norm());
}

TEST(PathSummary, ABodyThatFallsFromTheOriginDoesNotLand) {
  auto samples = throwInVacuum(9.81);
  for (MotionSample& sample : samples) sample.position.z() = -sample.time;
  EXPECT_FALSE(summarisePath(samples, Vector3(0, 0, -9.81)).landing);
  EXPECT_NEAR(summarisePath(samples, Vector3(0, 0, -9.81)).descent_speed, 1, 1e-12);
}

TEST(PathSummary, MeasuresTheLengthOfAStraightPath) {
  auto samples = throwInVacuum(9.81);
  for (MotionSample& sample : samples) sample.position = Vector3(1, -2, 2) * sample.time;
  EXPECT_NEAR(summarisePath(samples, Vector3::Zero()).length, 3 * 3, 1e-12);
}

}  // namespace
}  // namespace ambient
