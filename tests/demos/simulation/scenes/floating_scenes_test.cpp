// Bodies at the surface of water: the scenes floating_cube, heave_decay, wedge_drop, boat_in_waves,
// duck_dive and pool.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/demos/simulation/scenes/run_scene.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

double meanHeight(const std::vector<MotionSample>& motion, double from) {
  double sum = 0, count = 0;
  for (const MotionSample& sample : motion)
    if (sample.time >= from) {
      sum += sample.position.z();
      ++count;
    }
  return sum / count;
}

/// Cosine of the angle between the vertical and the nearest axis of the body.
double uprightness(const MotionSample& sample) {
  return (sample.orientation.conjugate() * Vector3::UnitZ()).cwiseAbs().maxCoeff();
}

// Flat below 0.2113 and above 0.7887 times the density of water, corner up at 0.5. The heaviest
// cube has a small righting moment and rocks for half a minute.
TEST(FloatingCube, SettlesAsItsDensityTells) {
  Scene scene = readNamedScene("floating_cube");
  scene.duration = 40;
  const RunRecord run = runSharing(scene);
  const auto last = [&](std::size_t i) { return uprightness(run.motion[i].back()); };
  EXPECT_GT(last(0), 0.995);
  EXPECT_GT(last(4), 0.995);
  EXPECT_LT(last(2), std::cos(0.7));  // 0.577 corner up, 0.707 edge up
  EXPECT_LT(last(3), 0.98);
  for (std::size_t i : {0U, 4U}) {
    const double gravity = scene.bodies[i].mass / (998 * 0.027);
    EXPECT_NEAR(meanHeight(run.motion[i], 30), 0.3 * (0.5 - gravity), 0.01) << i;
  }
}

// Kramer et al. 2021: period 0.76 s. Linear theory: extremes of -0.866, 0.633, -0.463 of the start.
TEST(HeaveDecay, HasThePeriodAndTheDecayOfLinearTheory) {
  const auto motion = motionOf("heave_decay");
  std::vector<double> extremes, times;
  constexpr double kBalance = -0.0348, kStart = 0.03;
  for (std::size_t i = 1; i + 1 < motion.size() && extremes.size() < 4; ++i) {
    const double before = motion[i - 1].position.z(), now = motion[i].position.z(),
                 after = motion[i + 1].position.z();
    if ((now - before) * (after - now) <= 0 && motion[i].time > 0.1) {
      extremes.push_back((now - kBalance) / kStart);
      times.push_back(motion[i].time);
    }
  }
  ASSERT_GE(extremes.size(), 3U);
  EXPECT_NEAR(extremes[0], -0.866, 0.04);
  EXPECT_NEAR(extremes[1], 0.633, 0.04);
  EXPECT_NEAR(extremes[2], -0.463, 0.04);
  EXPECT_NEAR(times[2] - times[0], 0.763, 0.02 * 0.763);
}

TEST(WedgeDrop, TheWaterStopsIt) {
  const RunRecord run = runSharing(readNamedScene("wedge_drop"));
  for (const auto& motion : run.motion) {
    double fastest = 0, lowest = 0;
    for (const MotionSample& sample : motion) {
      fastest = std::min(fastest, sample.twist.linear.z());
      lowest = std::min(lowest, sample.position.z());
    }
    EXPECT_LT(fastest, -3.9);  // entry at 4 m/s
    EXPECT_GT(lowest, -1);
    EXPECT_LT(std::abs(motion.back().twist.linear.z()), 1);
  }
}

TEST(BoatInWaves, FloatsUprightAndGoesWithTheWaves) {
  const Scene scene = readNamedScene("boat_in_waves");
  const RunRecord run = runSharing(scene);
  for (const auto& motion : run.motion) {
    double highest = -9, lowest = 9;
    for (const MotionSample& sample : motion) {
      if (sample.time < 5) continue;
      highest = std::max(highest, sample.position.z());
      lowest = std::min(lowest, sample.position.z());
      EXPECT_GT((sample.orientation * Vector3::UnitZ()).z(), 0.7);
    }
    // Wave amplitudes of 0.12 and 0.04 m.
    EXPECT_NEAR(highest - lowest, 0.32, 0.12);
    EXPECT_NEAR((highest + lowest) / 2, 0, 0.15);
  }
}

// Jump height exceeds the depth, but not the energy of buoyancy. The heavy ball hardly leaves the
// water.
TEST(DuckDive, LightBallsJump) {
  const RunRecord run = runSharing(readNamedScene("duck_dive", {{"duration", "9"}}));
  const auto highest = [&](std::size_t i) {
    double height = -9;
    for (const MotionSample& sample : run.motion[i]) height = std::max(height, sample.position.z());
    return height;
  };
  EXPECT_GT(highest(0), 0.3);
  EXPECT_GT(highest(0), highest(1));
  EXPECT_LT(highest(2), 0.1);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(run.motion[i].back().twist.linear.norm(), 0.5) << i;
}

TEST(Pool, KeepsItsBoxesAndSinksTheHeavyOnes) {
  const Scene scene = readNamedScene("pool", {{"duration", "6"}});
  const RunRecord run = runSharing(scene);
  for (std::size_t i = 5; i < scene.bodies.size(); ++i) {
    const Vector3 end = run.motion[i].back().position;
    EXPECT_LT(std::max(std::abs(end.x()), std::abs(end.y())), 2.2) << scene.bodies[i].name;
    const bool sinks = scene.bodies[i].mass > 998 * 0.0144;
    if (sinks) {
      EXPECT_LT(end.z(), -0.3) << scene.bodies[i].name;
    } else {
      EXPECT_GT(end.z(), -0.5) << scene.bodies[i].name;
      EXPECT_LT(end.z(), 0.5) << scene.bodies[i].name;
    }
  }
}

// Pressure does not spin a body of revolution about its axis, whatever waves it meets: a float on a
// spar with a plate below, 30 waves of 2.5 m and 8 s across the mirrors of its mesh.
TEST(Buoy, DoesNotSpinInWaves) {
  const TemporaryFolder folder;
  writeText(folder / "buoy.json", R"({
    "duration": 240, "time_step": 0.016666666666666666, "output_step": 0.1,
    "water": {"level": 0, "waves": [{"amplitude": 1.25, "period": 8, "direction": [0.8, 0.6, 0]}]},
    "bodies": [{"mass": 2.5e5, "position": [0, 0, -2], "centre_of_mass": [0, 0, -2], "skin_friction": false,
      "shape": {"type": "compound", "parts": [
        {"shape": {"type": "cylinder", "radius": 5, "height": 4}},
        {"shape": {"type": "cylinder", "radius": 2, "height": 6}, "position": [0, 0, -4]},
        {"shape": {"type": "cylinder", "radius": 4, "height": 1}, "position": [0, 0, -7]}]}}]})");
  double turn = 0, before = 0, most_tilt = 0;
  const RunRecord record = run(readScene(folder / "buoy.json"));
  for (const MotionSample& sample : record.motion[0]) {
    const Vector3 axis = sample.orientation * Vector3::UnitZ();
    turn += axis.dot(sample.twist.angular) * (sample.time - before);
    before = sample.time;
    most_tilt = std::max(most_tilt, std::acos(std::min(1.0, axis.z())));
  }
  EXPECT_GT(most_tilt, 0.2);        // it does rock
  EXPECT_LT(std::abs(turn), 0.12);  // measured 0.087; without rings of parts some 0.7
}

// Two pontoons under a deck float up to their axes with the mass of half of the water that they
// could displace; a ball of lead falls through the gap between them.
TEST(Catamaran, FloatsOnItsPontoonsAndLetsABallThrough) {
  const TemporaryFolder folder;
  writeText(folder / "catamaran.json", R"({
    "duration": 20, "time_step": 0.016666666666666666, "water": {"level": 0, "density": 1000},
    "bodies": [
      {"mass": 1130.97, "position": [0, 0, 0.1], "centre_of_mass": [0, 0, 0], "shape": {"type": "compound", "parts": [
        {"shape": {"type": "cylinder", "radius": 0.3, "height": 4}, "position": [-1, 0, 0], "orientation": [1, 1, 0, 0]},
        {"shape": {"type": "cylinder", "radius": 0.3, "height": 4}, "position": [1, 0, 0], "orientation": [1, 1, 0, 0]},
        {"shape": {"type": "box", "size": [2.6, 1, 0.2]}, "position": [0, 0, 0.35]}]}},
      {"mass": 380, "position": [0, 1.3, 1], "shape": {"type": "sphere", "radius": 0.2}}]})");
  const RunRecord record = run(readScene(folder / "catamaran.json"));
  EXPECT_NEAR(meanHeight(record.motion[0], 10), 0, 0.01);
  EXPECT_GT(uprightness(record.motion[0].back()), 0.999);
  EXPECT_LT(record.motion[1].back().position.z(), -5);
}

}  // namespace
}  // namespace ambient
