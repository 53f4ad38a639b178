// Two blades in one piece: the scenes toy_propeller, underwater_propeller and paper_copter.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/demos/run_scene.h"

namespace ambient {
namespace {

Vector3 axisOf(const MotionSample& sample) { return sample.orientation * Vector3::UnitZ(); }

double spinOf(const MotionSample& sample) { return sample.twist.angular.dot(axisOf(sample)); }

std::vector<MotionSample> motionOf(const std::string& scene, const char* model = "ambient") {
  return runSharing(readNamedScene(scene, {{"model", model}})).motion[0];
}

double largestHeight(const std::vector<MotionSample>& motion) {
  double largest = 0;
  for (const MotionSample& sample : motion) largest = std::max(largest, sample.position.z());
  return largest;
}

TEST(ToyPropeller, ClimbsOnACurvedPath) {
  const auto motion = motionOf("toy_propeller");
  EXPECT_GT(largestHeight(motion), 0.3);
  // It leans to +x and goes there.
  EXPECT_GT(motion[motion.size() / 4].position.x(), 0.05);
  EXPECT_LT(spinOf(motion.back()), 0.8 * spinOf(motion.front()));
}

TEST(ToyPropeller, DoesNotClimbInAVacuumOrUnderLinearDrag) {
  EXPECT_LE(largestHeight(motionOf("toy_propeller", "vacuum")), 0);
  EXPECT_LT(largestHeight(motionOf("toy_propeller", "uwrbd")), 0.03);
}

TEST(UnderwaterPropeller, SpinsUpAsItSinks) {
  const auto motion = motionOf("underwater_propeller");
  EXPECT_EQ(spinOf(motion.front()), 0);
  double largest_spin = 0;
  for (const MotionSample& sample : motion) largest_spin = std::max(largest_spin, -spinOf(sample));
  EXPECT_GT(largest_spin, 1.2);
  EXPECT_LT(motion.back().position.z(), -0.1);
}

TEST(PaperCopter, RightsItselfAndSpinsSteadily) {
  const auto motion = motionOf("paper_copter");
  double least_spin = 1e9, largest_spin = 0, largest_tilt = 0;
  for (const MotionSample& sample : motion) {
    if (sample.time < motion.back().time / 2) continue;
    least_spin = std::min(least_spin, std::abs(spinOf(sample)));
    largest_spin = std::max(largest_spin, std::abs(spinOf(sample)));
    // Against the descent.
    const double cosine = -axisOf(sample).dot(sample.twist.linear.normalized());
    largest_tilt = std::max(largest_tilt, std::acos(std::min(cosine, 1.0)));
  }
  EXPECT_LT(largest_tilt, 15 * std::acos(-1.0) / 180);
  EXPECT_GT(least_spin, 50);
  EXPECT_LT(largest_spin / least_spin, 1.05);
}

TEST(PaperCopter, FallsAtASteadySpeed) {
  const auto motion = motionOf("paper_copter");
  const double late = motion.back().twist.linear.z();
  const double middle = motion[motion.size() / 2].twist.linear.z();
  EXPECT_LT(late, -1);
  EXPECT_NEAR(late / middle, 1, 0.02);
}

}  // namespace
}  // namespace ambient
