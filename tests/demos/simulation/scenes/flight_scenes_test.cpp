// Balls in flight: range and drift of the scenes golf_*, basketball_drop, soccer_curl and football.
// Their numbers come from tests/reference/ellipsoid_flight.h, which shares neither faces nor
// integrator with the library.

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "demos/analysis/path_summary.h"
#include "tests/demos/simulation/scenes/reference_flight.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

/// First landing: the sample where a body falls through z = 0.
MotionSample landingOf(const RunRecord& record, const Scene& scene, std::size_t body = 0) {
  return summarisePath(record.motion[body], scene.gravity).landing.value();
}

MotionSample landingOf(const std::string& name) {
  const Scene scene = readNamedScene(name);
  const RunRecord record = runSharing(scene);
  EXPECT_EQ(record.work[0].guarded, 0) << name;
  return landingOf(record, scene);
}

TEST(GolfScenes, TheBallLandsWhereTheReferenceDoes) {
  struct Case {
    const char* scene;
    double tolerance;
  };
  for (const auto& [name, tolerance] :
       {Case{"golf_smooth", 2e-3}, Case{"golf_dimpled", 2e-3}, Case{"golf_smooth_spin", 5e-3},
        Case{"golf_dimpled_spin", 5e-3}}) {
    const Scene scene = readNamedScene(name);
    reference::EllipsoidFlight flight = referenceFlight(scene);
    const Vector3 expected = flight.passageThrough(0, 0.02);
    const MotionSample landing = landingOf(name);
    EXPECT_NEAR(landing.position.x(), expected.x(), tolerance * expected.x()) << name;
    EXPECT_NEAR(landing.time, flight.time(), tolerance * flight.time()) << name;
  }
}

TEST(SoccerScene, DriftsAsTheReference) {
  const Scene scene = readNamedScene("soccer_curl");
  reference::EllipsoidFlight flight = referenceFlight(scene);
  for (int i = 0; i < 50; ++i) flight.advance(0.02);
  const Vector3 end = runSharing(scene).motion[0].back().position;
  EXPECT_NEAR(end.y(), flight.position().y(), 0.01 * flight.position().y());
  EXPECT_LT((end - flight.position()).norm(), 5e-3 * end.norm());
}

TEST(BasketballScene, DriftsAsTheReferenceAndNotWithoutSpin) {
  const Scene scene = readNamedScene("basketball_drop");
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

TEST(BasketballScene, TheGuardIsSilent) {
  const RunRecord record = runSharing(readNamedScene("basketball_drop"));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(record.work[i].guarded, 0) << i << " turns";
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
  EXPECT_NEAR(caught.position.x(), 66.4, 0.01 * 66.4);
}

TEST(FootballScene, FliesAsTheReference) {
  // The published law: the form law leaves out the circulation of a hull, and flies 0.5 % shorter.
  const Scene scene = readNamedScene("football", {{"law", "published"}});
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

}  // namespace
}  // namespace ambient
