#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bullet_ambient/base/pi.h"
#include "demos/analysis/path_summary.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

const Vector3 kGravity(0, 0, -9.81);

/// A plate that falls at 0.5 m/s and drifts at 0.3 m/s, its tilt about y a function of time.
std::vector<MotionSample> fallWithTilt(const std::function<double(double)>& tilt,
                                       double duration = 8) {
  std::vector<MotionSample> samples;
  constexpr double kStep = 0.01;
  for (int i = 0; i * kStep <= duration + kStep / 2; ++i) {
    MotionSample sample;
    sample.time = i * kStep;
    sample.position = Vector3(0.3, 0, -0.5) * sample.time;
    sample.orientation = Eigen::AngleAxisd(tilt(sample.time), Eigen::Vector3d::UnitY());
    samples.push_back(sample);
  }
  return samples;
}

Fall analyse(const std::vector<MotionSample>& samples) {
  return analyseFall(samples, Vector3::UnitZ(), kGravity);
}

double degrees(double angle) { return angle * kPi / 180; }

/// A plate that swings once a second; amplitude in degrees, decay in 1/s.
std::vector<MotionSample> swinging(double amplitude, double decay = 0) {
  return fallWithTilt(
      [=](double t) { return degrees(amplitude) * std::exp(-decay * t) * std::cos(2 * kPi * t); });
}

TEST(FallingMode, SwingingIsFlutter) {
  // Broadside at 0.25 + k / 2 s: 16 times in 8 s, 15 half cycles between them; samples are 0.01 s
  // apart.
  const Fall fall = analyse(swinging(60));
  EXPECT_EQ(fall.mode, FallingMode::kFlutter);
  EXPECT_EQ(fall.swings, 15);
  EXPECT_EQ(fall.overturns, 0);
  EXPECT_EQ(fall.turns, 0);
  EXPECT_NEAR(fall.largest_swing, degrees(60), 1e-12);
  ASSERT_EQ(fall.events.size(), 15u);
  for (std::size_t k = 0; k < fall.events.size(); ++k) {
    EXPECT_FALSE(fall.events[k].is_overturn);
    EXPECT_NEAR(fall.events[k].time, 0.75 + 0.5 * static_cast<double>(k), 0.0101);
  }
  const Fall beyond_the_vertical = analyse(swinging(120));
  EXPECT_EQ(beyond_the_vertical.mode, FallingMode::kFlutter);
  EXPECT_EQ(beyond_the_vertical.overturns, 0);
}

TEST(FallingMode, WobblesBelowTheThresholdAndWhatDiesOutEarlyAreSteady) {
  const Fall wobbles = analyse(swinging(9)), dies = analyse(swinging(80, 1)),
             still = analyse(fallWithTilt([](double) { return 0.3; }));
  for (const Fall& fall : {wobbles, dies, still}) EXPECT_EQ(fall.mode, FallingMode::kSteady);
  EXPECT_EQ(wobbles.swings, 0);
  EXPECT_GT(dies.swings, 0);
  EXPECT_TRUE(still.swing_axis.isZero());
}

TEST(FallingMode, TurningOnIsTumblingEitherWay) {
  for (const double sign : {1.0, -1.0}) {
    // From 85 degrees on, 10 half turns in 8 s, broadside 10 times: 9 overturns.
    const Fall fall =
        analyse(fallWithTilt([&](double t) { return degrees(85) + sign * 10 * kPi * t / 8; }));
    EXPECT_EQ(fall.mode, FallingMode::kTumbling);
    EXPECT_EQ(fall.overturns, 9);
    EXPECT_EQ(fall.swings, 0);
    EXPECT_EQ(fall.turns, 4.5);
  }
}

TEST(FallingMode, TurningThenSwingingIsMixed) {
  // Overturned at 1, ..., 6 half turns; then 8 returns to 6 half turns.
  const double swing = degrees(50);
  const double phase = std::asin(0.3 / swing);
  const auto tilt = [&](double t) {
    return t < 4 ? 0.3 + 6 * kPi * t / 4 : 6 * kPi + swing * std::sin(2 * kPi * (t - 4) + phase);
  };
  const Fall fall = analyse(fallWithTilt(tilt));
  EXPECT_EQ(fall.mode, FallingMode::kMixed);
  EXPECT_EQ(fall.overturns, 5);
  EXPECT_EQ(fall.swings, 8);
}

TEST(FallingMode, OneSwingAmongManyOverturnsIsTumbling) {
  const auto tilt = [](double t) {
    if (t < 4) return 20.5 * kPi * t / 4;
    return 20.5 * kPi + (t - 4) * (t - 4.5) * 10 * kPi;
  };
  const Fall fall = analyse(fallWithTilt(tilt));
  EXPECT_GE(fall.swings, 1);
  EXPECT_LE(fall.swings, kPureShare * (fall.swings + fall.overturns));
  EXPECT_EQ(fall.mode, FallingMode::kTumbling);
}

TEST(FallingMode, SpeedsAreThoseOfTheSecondHalf) {
  auto samples = fallWithTilt([](double) { return 0.0; });
  for (std::size_t i = 0; i < samples.size() / 2; ++i) samples[i].position *= 0.1;
  const Fall fall = analyse(samples);
  EXPECT_NEAR(fall.descent_speed, 0.5, 1e-12);
  EXPECT_NEAR(fall.drift_speed, 0.3, 1e-12);
}

TEST(FallingMode, DoesNotDependOnDirectionsInTheWorld) {
  // Turns the fall: gravity along -x and the plate's normal along its y axis.
  const Quaternion turn(rotationBetween(Vector3::UnitZ(), Vector3::UnitX()));
  const Quaternion normal_to_z(rotationBetween(Vector3::UnitY(), Vector3::UnitZ()));
  auto samples = fallWithTilt([](double t) { return degrees(85) - 2 * kPi * t; });
  const Fall expected = analyse(samples);
  for (MotionSample& sample : samples) {
    sample.position = turn * sample.position;
    sample.orientation = turn * sample.orientation * normal_to_z;
  }
  const Fall fall = analyseFall(samples, Vector3::UnitY(), turn * kGravity);
  EXPECT_EQ(fall.mode, expected.mode);
  EXPECT_EQ(fall.overturns, expected.overturns);
  EXPECT_NEAR(fall.descent_speed, expected.descent_speed, 1e-12);
  EXPECT_NEAR(fall.drift_speed, expected.drift_speed, 1e-12);
}

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
