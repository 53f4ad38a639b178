#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "demos/analysis/path_summary.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

// Balls in flight: range and drift of the scenes golf_*, basketball_drop and football.
// Their numbers come from tests/reference/ellipsoid_flight.h, which shares neither faces nor
// integrator with the library.

/// First landing: the sample where a body falls through z = 0.
MotionSample landingOf(const RunRecord& record, const Scene& scene, std::size_t body = 0) {
  return summarisePath(record.motion[body], scene.gravity).landing.value();
}

/// A scene by the published law at a separation angle [rad], as the reference has it.
Scene publishedScene(const std::string& name, double angle = 1.5707963267948966) {
  std::vector<SceneOverride> overrides{{"law", "published"}};
  for (std::size_t i = 0; i < readNamedScene(name).bodies.size(); ++i)
    overrides.push_back(
        {"bodies." + std::to_string(i) + ".separation_angle", std::to_string(angle)});
  return readNamedScene(name, overrides);
}

MotionSample landingOf(const Scene& scene) {
  const RunRecord record = runSharing(scene);
  return landingOf(record, scene);
}

TEST(GolfScenes, TheBallLandsWhereTheReferenceDoes) {
  constexpr double kDimpled = 2.356194490192345, kSmooth = 1.5707963267948966;
  constexpr double tolerance = 1e-2;  // a ball of 1152 faces
  for (const auto& [name, angle] :
       {std::pair{"golf_smooth", kSmooth}, std::pair{"golf_dimpled", kDimpled},
        std::pair{"golf_smooth_spin", kSmooth}, std::pair{"golf_dimpled_spin", kDimpled}}) {
    const Scene scene = publishedScene(name, angle);
    reference::EllipsoidFlight flight = referenceFlight(scene);
    const Vector3 expected = flight.passageThrough(0, 0.02);
    const MotionSample landing = landingOf(scene);
    EXPECT_NEAR(landing.position.x(), expected.x(), tolerance * expected.x()) << name;
    EXPECT_NEAR(landing.time, flight.time(), tolerance * flight.time()) << name;
  }
}

// Dropped from 126.5 m with 1, 2 and 3 turns a second, and golf balls hit: as measured.
TEST(BallScenes, FlyAsMeasuredByTheDefaultLaw) {
  const Scene basketballs = readNamedScene("basketball_drop");
  const RunRecord record = runSharing(basketballs);
  const double drifts[] = {20, 30, 36};
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_NEAR(landingOf(record, basketballs, i).position.x(), drifts[i - 1], 3) << i << " turns";
  EXPECT_NEAR(landingOf(readNamedScene("golf_dimpled_spin")).position.x(), 142.5, 7.5);
}

/// Passage of a body downwards through a height, interpolated linearly between two samples.
MotionSample passageOf(const std::vector<MotionSample>& motion, double height) {
  std::size_t i = 1;
  while (motion[i].position.z() > height || motion[i].twist.linear.z() > 0) ++i;
  const MotionSample &a = motion[i - 1], &b = motion[i];
  const double share = (height - a.position.z()) / (b.position.z() - a.position.z());
  MotionSample passage = b;
  passage.time = a.time + share * (b.time - a.time);
  passage.position = a.position + share * (b.position - a.position);
  return passage;
}

TEST(FootballScene, IsCaughtWhereRaeMeasuredIt) {
  // Throw and catch at one height: Rae 2003 gives 66.4 m.
  const Scene scene = readNamedScene("football");
  const MotionSample caught = passageOf(runSharing(scene).motion[0], scene.bodies[0].position.z());
  EXPECT_NEAR(caught.position.x(), 66.4, 0.015 * 66.4);
}

TEST(FootballScene, FliesAsTheReference) {
  const Scene scene = publishedScene("football", 2.356194490192345);
  reference::EllipsoidFlight flight = referenceFlight(scene);
  const Vector3 expected = flight.passageThrough(0, 4e-3);
  const MotionSample caught = passageOf(runSharing(scene).motion[0], scene.bodies[0].position.z());
  EXPECT_NEAR(caught.time, flight.time(), 5e-3 * flight.time());
  const Vector3 way = caught.position - scene.bodies[0].position;
  EXPECT_NEAR(way.x(), expected.x(), 5e-3 * expected.x());
  EXPECT_NEAR(way.y(), expected.y(), 5e-3 * expected.x());
}

// Two blades in one piece: the scene toy_propeller; the paper copters and the winged seed.

Vector3 axisOf(const MotionSample& sample) { return sample.orientation * Vector3::UnitZ(); }

double spinOf(const MotionSample& sample) { return sample.twist.angular.dot(axisOf(sample)); }

TEST(ToyPropeller, ClimbsOnACurvedPath) {
  const auto motion = motionOf("toy_propeller");
  double highest = 0;
  for (const MotionSample& sample : motion) highest = std::max(highest, sample.position.z());
  EXPECT_GT(highest, 0.3);
  // The propeller leans and moves to +x.
  EXPECT_GT(motion[motion.size() / 4].position.x(), 0.05);
  EXPECT_LT(spinOf(motion.back()), 0.8 * spinOf(motion.front()));
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

/// Scene of a body whose wings are found, by the default law.
Scene withWings(const std::string& name) {
  return readNamedScene(name, {{"law", "form"}, {"bodies.0.shape.wings", "auto"}});
}

// As it does in nature: 131 rad/s and 1.2 m/s. Either way round, from any attitude.
TEST(WingedSeedByTheDefaultLaw, AutorotatesFromRestInAnyAttitude) {
  Scene scene = withWings("winged_seed");
  scene.duration = 6;
  const auto bodies = prepareSharing(scene);
  const Quaternion turns[] = {scene.bodies[0].orientation,
                              {1, 0, 0, 0},
                              {0.7, 0, 0.714, 0},
                              {0.5, -0.5, 0.5, 0.5},
                              {0.3, 0.8, -0.2, 0.48}};
  for (const Quaternion& turn : turns) {
    scene.bodies[0].orientation = turn.normalized();
    const MotionSample late = runPrepared(scene, bodies).motion[0].back();
    EXPECT_GT(std::abs(late.twist.angular.z()), 120) << turn.coeffs().transpose();
    EXPECT_GT(late.twist.linear.z(), -1.4) << turn.coeffs().transpose();
  }
}

TEST(ToyPropeller, ClimbsByTheDefaultLaw) {
  const RunRecord record = runSharing(withWings("toy_propeller"));
  double top = 0;
  for (const MotionSample& sample : record.motion[0]) top = std::max(top, sample.position.z());
  EXPECT_GT(top, 0.6);
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
