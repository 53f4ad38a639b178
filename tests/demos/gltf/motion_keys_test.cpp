#include "demos/gltf/motion_keys.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {
namespace {

/// Sample of a motion with constant spin about a slanted axis and constant velocity.
MotionSample spinningAt(double time, double spin) {
  const Vector3 axis = Vector3(1, 2, -2) / 3;
  MotionSample sample;
  sample.time = time;
  sample.position = Vector3(3, 0, -1) * time;
  sample.orientation = Quaternion(Eigen::AngleAxisd(spin * time, axis));
  sample.twist = {spin * axis, Vector3(3, 0, -1)};
  return sample;
}

std::vector<MotionSample> keysOf(double spin, double step, int steps) {
  std::vector<MotionSample> motion;
  for (int i = 0; i <= steps; ++i) motion.push_back(spinningAt(i * step, spin));
  return makeMotionKeys(motion);
}

TEST(MotionKeys, AreTheSamplesOfASlowBody) { EXPECT_EQ(keysOf(10, 0.01, 7).size(), 8u); }

TEST(MotionKeys, FollowASpinOfManyTurnsPerSample) {
  const double spin = 5000;  // 8 turns per step
  const std::vector<MotionSample> keys = keysOf(spin, 0.01, 3);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const MotionSample exact = spinningAt(keys[k].time, spin);
    // 150 rad of turn: each rounding has an error of 150 * 2.2e-16.
    EXPECT_LT(angleBetween(keys[k].orientation, exact.orientation), 1e-12);
    EXPECT_LT((keys[k].position - exact.position).norm(), 1e-15);
    if (k == 0) continue;
    EXPECT_LT(keys[k - 1].time, keys[k].time);
    EXPECT_LT(angleBetween(keys[k - 1].orientation, keys[k].orientation), kPi / 4);
    EXPECT_GT(keys[k - 1].orientation.dot(keys[k].orientation), 0);
  }
  EXPECT_EQ(keys.back().time, 0.03);
}

TEST(MotionKeys, OfNothingAndOfOneSample) {
  EXPECT_TRUE(makeMotionKeys({}).empty());
  EXPECT_EQ(makeMotionKeys({spinningAt(0, 1)}).size(), 1u);
}

}  // namespace
}  // namespace ambient
