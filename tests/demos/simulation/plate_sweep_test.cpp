// The 10 cm plate from 0.2 g to 1 kg, Padilla et al. 2025, section 5.1: flutter, then stable
// descent, then free fall.

#include <gtest/gtest.h>

#include <cmath>

#include "demos/analysis/path_summary.h"
#include "tests/demos/simulation/scenes/run_scene.h"

namespace ambient {
namespace {

class PlateSweep : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = readNamedScene("plate_mass_sweep");
    record_ = run(scene_);
  }

  static std::size_t bodyOfMass(double mass) {
    std::size_t body = 0;
    while (std::abs(scene_.bodies.at(body).mass - mass) > 1e-6 * mass) ++body;
    return body;
  }

  static const std::vector<MotionSample>& motionOfMass(double mass) {
    return record_.motion[bodyOfMass(mass)];
  }

  /// Largest angle between the plate's normal and the vertical from time `from` to `to` [degrees].
  static double largestTilt(double mass, double from, double to) {
    double largest = 0;
    for (const MotionSample& sample : motionOfMass(mass)) {
      if (sample.time < from || sample.time > to) continue;
      const double cosine = std::abs((sample.orientation * Vector3::UnitZ()).z());
      largest = std::max(largest, std::acos(std::min(cosine, 1.0)) * 180 / std::acos(-1.0));
    }
    return largest;
  }

  /// Distance behind a plate in a vacuum after one second [m].
  static double lagAfterOneSecond(double mass) {
    for (const MotionSample& sample : motionOfMass(mass))
      if (std::abs(sample.time - 1) < 1e-9) return 9.81 / 2 + sample.position.z();
    return -1;
  }

  static Scene scene_;
  static RunRecord record_;
};

Scene PlateSweep::scene_;
RunRecord PlateSweep::record_;

TEST_F(PlateSweep, TheLightestFlutters) {
  const Fall fall = analyseFall(motionOfMass(0.0002), Vector3::UnitZ(), scene_.gravity);
  EXPECT_EQ(fallingModeName(fall.mode), fallingModeName(FallingMode::kFlutter));
  EXPECT_GT(largestTilt(0.0002, 2, 3), 60);
}

TEST_F(PlateSweep, HeavierOnesSettleFlatSideDown) {
  for (const double mass : {0.005, 0.01, 0.02}) {
    EXPECT_GT(largestTilt(mass, 0.5, 1), 40) << mass;
    EXPECT_LT(largestTilt(mass, 2.5, 3), 20) << mass;
  }
}

TEST_F(PlateSweep, TheHeaviestFallAsInAVacuumWithALagThatGoesWithOneOverTheMass) {
  const double heaviest = lagAfterOneSecond(1);
  EXPECT_LT(heaviest, 0.002 * 9.81 / 2 * 1.1);
  EXPECT_GT(heaviest, 0);
  EXPECT_NEAR(lagAfterOneSecond(0.5) / heaviest, 2, 0.2);
  EXPECT_NEAR(lagAfterOneSecond(0.1) / heaviest, 10, 2);
}

}  // namespace
}  // namespace ambient
