#include "bullet_ambient/motion/body/wake.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

constexpr double kDiameter = 0.3, kArea = kPi * kDiameter * kDiameter;
constexpr double kVolume = kArea * kDiameter / 6;

Twist along(double speed) { return {Vector3::Zero(), {0, 0, speed}}; }

/// Share at each way in diameters, from rest at a constant speed.
double shareAfter(double diameters, double speed, int steps) {
  Wake wake;
  developWake({along(0), kArea, kVolume, 1}, wake);
  const double duration = diameters * kDiameter / speed / steps;
  for (int i = 0; i < steps; ++i) developWake({along(speed), kArea, kVolume, duration}, wake);
  return developWake({along(speed), kArea, kVolume, duration}, wake);
}

TEST(Wake, DevelopsOverAWayWhateverSpeedAndStep) {
  for (const double diameters : {0.1, 1.0, 3.0}) {
    const double expected = std::min(1.0, std::pow((1 - std::exp(-diameters / 1.5)) / 0.7, 2));
    EXPECT_NEAR(shareAfter(diameters, 0.01, 1), expected, 1e-12) << diameters;
    EXPECT_NEAR(shareAfter(diameters, 100, 50), expected, 1e-12) << diameters;
  }
  EXPECT_EQ(shareAfter(1.9, 1, 7), 1);
}

TEST(Wake, IsThatOfTheMotionInWhichABodyIsAdded) {
  Wake wake;
  EXPECT_EQ(developWake({along(3), kArea, kVolume, 0.1}, wake), 1);
  EXPECT_EQ(developWake({along(3), kArea, kVolume, 0.1}, wake), 1);
  EXPECT_EQ(developWake({along(2.5), kArea, kVolume, 0.1}, wake),
            1);  // slower: goes on in its wake
}

TEST(Wake, IsNoneAfterAReversal) {
  Wake wake;
  developWake({along(1), kArea, kVolume, 1}, wake);
  EXPECT_EQ(developWake({along(-1), kArea, kVolume, 0.001}, wake), 0);
}

TEST(Wake, OfASmallSwingIsNearlyNone) {
  // Amplitude of a tenth of the diameter, a period of 1 s; mean over the work against a drag.
  Wake wake;
  developWake({along(0), kArea, kVolume, 1}, wake);
  double work = 0, of_developed = 0;
  for (int i = 0; i < 2400; ++i) {
    const double speed = 0.1 * kDiameter * 2 * kPi * std::sin(2 * kPi * i / 240.0);
    const double share = developWake({along(speed), kArea, kVolume, 1 / 240.0}, wake);
    work += share * std::pow(std::abs(speed), 3);
    of_developed += std::pow(std::abs(speed), 3);
  }
  EXPECT_LT(work, 0.1 * of_developed);
  EXPECT_GT(work, 0);
}

TEST(Wake, ShareIsBetweenNoneAndAllWhateverTheMotion) {
  test::Arbitrary arbitrary(5);
  Wake wake;
  for (int i = 0; i < 2000; ++i) {
    const double speed = std::pow(10, arbitrary.between(-150, 100));
    const double share =
        developWake({arbitrary.twist(speed, speed), kArea, kVolume, arbitrary.between(0, 1)}, wake);
    ASSERT_TRUE(share >= 0 && share <= 1) << i << " " << share;
    ASSERT_TRUE(wake.velocity_W.vector().allFinite()) << i;
  }
}

TEST(Wake, TurnsWithTheBody) {
  // A roll has a wake of its own: it needs no way of the centre.
  Wake wake;
  const Twist roll{{2, 0, 0}, Vector3::Zero()};
  developWake({along(0), kArea, kVolume, 1}, wake);
  EXPECT_EQ(developWake({roll, kArea, kVolume, 0.1}, wake), 0);
  const double way = 2 * 0.1 * kDiameter / 2;
  EXPECT_NEAR(developWake({roll, kArea, kVolume, 0.1}, wake),
              std::pow((1 - std::exp(-way / (1.5 * kDiameter))) / 0.7, 2), 1e-12);
}

}  // namespace
}  // namespace ambient
