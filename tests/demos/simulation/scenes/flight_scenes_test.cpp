#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "demos/analysis/path_summary.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

// Balls in flight: range and drift of the scenes golf_*, basketball_drop, soccer_curl and football.
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

TEST(SoccerScene, DriftsAsTheReference) {
  const Scene scene = publishedScene("soccer_curl");
  reference::EllipsoidFlight flight = referenceFlight(scene);
  for (int i = 0; i < 50; ++i) flight.advance(0.02);
  const Vector3 end = runSharing(scene).motion[0].back().position;
  EXPECT_NEAR(end.y(), flight.position().y(), 0.02 * flight.position().y());
  EXPECT_LT((end - flight.position()).norm(), 5e-3 * end.norm());
}

TEST(BasketballScene, DriftsAsTheReferenceAndNotWithoutSpin) {
  const Scene scene = publishedScene("basketball_drop", 1.8849555921538759);
  const RunRecord record = runSharing(scene);
  EXPECT_NEAR(landingOf(record, scene, 0).position.x(), 0, 1e-3);
  for (std::size_t i = 1; i < 4; ++i) {
    const Vector3 landing = landingOf(record, scene, i).position;
    const double drop = -scene.bodies[i].position.z();
    const double drift = referenceFlight(scene, i).passageThrough(drop, 0.02).x();
    EXPECT_NEAR(landing.x(), drift, 5e-3 * drift) << i << " turns";
    EXPECT_NEAR(landing.y(), scene.bodies[i].position.y(), 0.01) << i << " turns";
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

TEST(BasketballScene, DoesNotDriftInAVacuum) {
  const Scene scene = readNamedScene("basketball_drop", {{"model", "vacuum"}});
  const RunRecord record = runSharing(scene);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(landingOf(record, scene, i).position.x(), 0);
}

/// Angles between the long axis and the velocity over the second half of the flight [degrees].
struct AxisAngles {
  double largest = 0;
  double mean = 0;
};

AxisAngles secondHalfAngles(const std::vector<MotionSample>& motion, double landing_time) {
  AxisAngles angles;
  int count = 0;
  for (const MotionSample& sample : motion) {
    if (sample.time < landing_time / 2 || sample.time > landing_time) continue;
    const Vector3 axis = sample.orientation * Vector3::UnitX();
    const double cosine = axis.dot(sample.twist.linear.normalized());
    const double angle = std::acos(std::min(cosine, 1.0)) * 180 / kPi;
    angles.largest = std::max(angles.largest, angle);
    angles.mean += angle;
    ++count;
  }
  angles.mean /= count;
  return angles;
}

AxisAngles secondHalfAngles(const std::string& name) {
  const Scene scene = readNamedScene(name);
  const RunRecord record = runSharing(scene);
  return secondHalfAngles(record.motion[0], landingOf(record, scene).time);
}

TEST(FootballScene, TheAxisFollowsThePathInAirOnly) {
  // Measured 9.6 degrees; 9.8 with four times the faces, 9.6 with half the step.
  const AxisAngles angles = secondHalfAngles("football");
  EXPECT_LT(angles.largest, 10);
  EXPECT_LT(angles.mean, 7);
  EXPECT_GT(secondHalfAngles("football_vacuum").largest, 60);
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

/// Checked number of a scene: landing place of the last body, or its drift at the end.
double gatedNumber(const Scene& scene) {
  const RunRecord record = runSharing(scene);
  const std::size_t last = scene.bodies.size() - 1;
  const PathSummary path = summarisePath(record.motion[last], scene.gravity);
  return path.landing ? path.landing->position.x() : record.motion[last].back().position.y();
}

/// Scene `name` with another number of faces on all bodies.
Scene withFaces(const std::string& name, int faces) {
  std::vector<SceneOverride> overrides;
  for (std::size_t i = 0; i < readNamedScene(name).bodies.size(); ++i)
    overrides.push_back({"bodies." + std::to_string(i) + ".shape.faces", std::to_string(faces)});
  return readNamedScene(name, overrides);
}

TEST(FlightScenes, HalfTheStepKeepsTheGatedNumbers) {
  for (const char* name : {"golf_dimpled_spin", "soccer_curl", "basketball_drop", "football"}) {
    Scene scene = readNamedScene(name);
    const double whole = gatedNumber(scene);
    scene.time_step /= 2;
    // Measured 0.26 % for the free kick with 1280 faces, since each face is attached or separated
    // as a whole; 0.03 % with 20000.
    EXPECT_NEAR(gatedNumber(scene), whole, 4e-3 * std::abs(whole)) << name;
  }
}

TEST(FlightScenes, AQuarterOfTheFacesKeepsTheGatedNumbers) {
  struct Case {
    const char* scene;
    int faces;
  };
  for (const auto& [scene, faces] : {Case{"golf_smooth", 5120}, Case{"soccer_curl", 1280},
                                     Case{"basketball_drop", 1280}, Case{"football", 780}}) {
    const double fine = gatedNumber(withFaces(scene, faces));
    EXPECT_NEAR(gatedNumber(withFaces(scene, faces / 4)), fine, 0.01 * std::abs(fine)) << scene;
  }
}

// Two blades in one piece: the scenes toy_propeller and underwater_propeller; the paper
// copters and the winged seed.

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
