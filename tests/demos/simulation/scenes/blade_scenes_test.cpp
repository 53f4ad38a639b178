// Two blades in one piece: the scenes toy_propeller and underwater_propeller; the paper
// copters and the winged seed.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/demos/simulation/scenes/scene_loads.h"

namespace ambient {
namespace {

Vector3 axisOf(const MotionSample& sample) { return sample.orientation * Vector3::UnitZ(); }

double spinOf(const MotionSample& sample) { return sample.twist.angular.dot(axisOf(sample)); }

double largestHeight(const std::vector<MotionSample>& motion) {
  double largest = 0;
  for (const MotionSample& sample : motion) largest = std::max(largest, sample.position.z());
  return largest;
}

TEST(ToyPropeller, ClimbsOnACurvedPath) {
  const auto motion = motionOf("toy_propeller");
  EXPECT_GT(largestHeight(motion), 0.3);
  // The propeller leans and moves to +x.
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

/// Spin and tilt of a copter in the second half of its flight.
struct Autorotation {
  double least_spin = 1e9, largest_spin = 0;  ///< about its axis, either way [rad/s]
  double largest_tilt = 0;                    ///< axis to direction of descent [rad]

  explicit Autorotation(const std::vector<MotionSample>& motion) {
    for (const MotionSample& sample : motion) {
      if (sample.time < motion.back().time / 2) continue;
      least_spin = std::min(least_spin, std::abs(spinOf(sample)));
      largest_spin = std::max(largest_spin, std::abs(spinOf(sample)));
      const double cosine = -axisOf(sample).dot(sample.twist.linear.normalized());
      largest_tilt = std::max(largest_tilt, std::acos(std::min(cosine, 1.0)));
    }
  }
};

const double kDegree = std::acos(-1.0) / 180;

/// A sheet, and the thick model of the paper.
class PaperCopter : public ::testing::TestWithParam<const char*> {
 protected:
  PaperCopter() : scene_(readCoarseScene(GetParam(), folder_)), bodies_(prepare(scene_)) {}

  TemporaryFolder folder_;
  Scene scene_;
  std::vector<PreparedBody> bodies_;
};

TEST_P(PaperCopter, RightsItselfAndSpinsSteadily) {
  const Autorotation late(runPrepared(scene_, bodies_).motion[0]);
  EXPECT_LT(late.largest_tilt, 5 * kDegree);
  EXPECT_GT(late.least_spin, 50);
  EXPECT_LT(late.largest_spin / late.least_spin, 1.02);
}

TEST_P(PaperCopter, FallsAtASteadySpeedThatPaysForItsDrag) {
  const auto motion = runPrepared(scene_, bodies_).motion[0];
  const double late = motion.back().twist.linear.z();
  EXPECT_LT(late, -1);
  EXPECT_NEAR(late / motion[motion.size() / 2].twist.linear.z(), 1, 0.02);
  const double given = weightIn(scene_, bodies_[0]) * -late;
  EXPECT_NEAR(-powerOfLoads(scene_, bodies_[0], motion.back()), given, 0.01 * given);
}

INSTANTIATE_TEST_SUITE_P(SheetAndProxy, PaperCopter,
                         ::testing::Values("paper_copter", "paper_copter_proxy"));

TEST(PaperCopterSheet, HasNoVolumeAndRightsItselfFromAnyTilt) {
  const TemporaryFolder folder;
  Scene scene = readCoarseScene("paper_copter", folder);
  const auto bodies = prepare(scene);
  EXPECT_EQ(bodies[0].fluid_body->volume, 0);
  for (const double tilt : {10, 60, 85, 120}) {
    for (const double azimuth : {15, 100}) {
      const Vector3 axis(std::cos(azimuth * kDegree), std::sin(azimuth * kDegree), 0);
      scene.bodies[0].orientation = Eigen::AngleAxisd(tilt * kDegree, axis);
      const Autorotation late(runPrepared(scene, bodies).motion[0]);
      EXPECT_LT(late.largest_tilt, 15 * kDegree) << tilt << " towards " << azimuth;
      EXPECT_NEAR(late.least_spin, 64, 3) << tilt << " towards " << azimuth;
    }
  }
}

TEST(PaperCopterSheet, HalfTheStepKeepsSpinAndDescent) {
  const TemporaryFolder folder;
  Scene scene = readCoarseScene("paper_copter", folder);
  const auto bodies = prepare(scene);
  const MotionSample whole = runPrepared(scene, bodies).motion[0].back();
  scene.time_step /= 2;
  const MotionSample half = runPrepared(scene, bodies).motion[0].back();
  EXPECT_NEAR(spinOf(half), spinOf(whole), 0.005 * std::abs(spinOf(whole)));
  EXPECT_NEAR(half.twist.linear.z(), whole.twist.linear.z(),
              0.005 * std::abs(whole.twist.linear.z()));
}

/// Steady rotation about the vertical with the wing spread.
struct SeedFlight {
  double least_spin = 1e9, largest_spin = 0;  ///< about the vertical [rad/s]
  double largest_cone = 0;                    ///< wing to the horizontal [rad]
  double descent = 0;                         ///< [m/s]

  explicit SeedFlight(const std::vector<MotionSample>& motion) {
    for (const MotionSample& sample : motion) {
      // Uses the last quarter.
      if (sample.time < 0.75 * motion.back().time) continue;
      least_spin = std::min(least_spin, sample.twist.angular.z());
      largest_spin = std::max(largest_spin, sample.twist.angular.z());
      const double rise = (sample.orientation * Vector3::UnitX()).z();
      largest_cone = std::max(largest_cone, std::abs(std::asin(rise)));
    }
    descent = -motion.back().twist.linear.z();
  }
};

class WingedSeed : public ::testing::Test {
 protected:
  // Default settings: with a coarser flow, rounding decides if the seed begins to rotate.
  WingedSeed() : scene_(readNamedScene("winged_seed")), bodies_(prepareSharing(scene_)) {}

  Scene scene_;
  std::vector<PreparedBody> bodies_;
};

TEST_F(WingedSeed, AutorotatesFromRest) {
  const SeedFlight flight(runPrepared(scene_, bodies_).motion[0]);
  // A maple seed has 131 rad/s and 1.2 m/s (Lee, Lee and Sohn 2014).
  EXPECT_GT(flight.least_spin, 200);
  EXPECT_LT(flight.largest_spin / flight.least_spin, 1.03);
  EXPECT_LT(flight.largest_cone, 10 * kDegree);
  EXPECT_GT(flight.descent, 0.7);
  EXPECT_LT(flight.descent, 1.2);
}

TEST_F(WingedSeed, WeightPaysForTheDragOfItsTurning) {
  const MotionSample end = runPrepared(scene_, bodies_).motion[0].back();
  const double given = weightIn(scene_, bodies_[0]) * -end.twist.linear.z();
  EXPECT_NEAR(-powerOfLoads(scene_, bodies_[0], end), given, 0.05 * given);
}

TEST_F(WingedSeed, SpunByHandKeepsTurningWhereverItsMassLiesAcrossTheChord) {
  scene_.bodies[0].orientation = Quaternion::Identity();
  scene_.bodies[0].angular_velocity = Vector3(0, 0, 230);
  const Vector3 designed = *scene_.bodies[0].centre_of_mass;
  double slower = 0;
  for (const double forward : {-0.003, 0.0, 0.004}) {
    scene_.bodies[0].centre_of_mass = designed + Vector3(0, forward, 0);
    const SeedFlight flight(runPrepared(scene_, prepareSharing(scene_)).motion[0]);
    EXPECT_GT(flight.least_spin, 180) << forward;
    EXPECT_LT(flight.largest_spin / flight.least_spin, 1.03) << forward;
    // A centre of mass farther forward makes descent faster.
    EXPECT_GT(flight.descent, slower) << forward;
    slower = flight.descent;
  }
  EXPECT_LT(slower, 1.4);
}

}  // namespace
}  // namespace ambient
