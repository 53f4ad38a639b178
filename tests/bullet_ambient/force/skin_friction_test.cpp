#include "bullet_ambient/force/law/skin_friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "tests/reference/loads/sphere_loads.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::skin_friction {
namespace {

// Golf ball in air; its launch speed and spin.
const reference::SphereInFluid kBall{0.02135, 1.204, 1.82e-5};
constexpr double kSpeed = 53;
const double kSpin = 42 * 2 * std::acos(-1.0);

LoadSettings ballSettings(double angle_in_right_angles) {
  return {kBall.density, kBall.viscosity, separationCosine(angle_in_right_angles * kPi / 2), true};
}

FaceTable ballFaces(int level) {
  return test::faceTableOf(test::geodesicEllipsoid(Vector3::Constant(kBall.radius), level));
}

const double kLength = std::sqrt(4 * kPi) * kBall.radius;

TEST(SphereFrictionReference, HasTheTabulatedValues) {
  EXPECT_NEAR(reference::sphereFrictionDrag(kBall, kSpeed, kPi / 2), 0.01382554906, 1e-11);
  EXPECT_NEAR(reference::sphereFrictionDrag(kBall, kSpeed, 0.75 * kPi), 0.02651367823, 1e-11);
  EXPECT_NEAR(reference::sphereFrictionTorque(kBall, kSpin), 1.0444853816e-05, 1e-15);
}

TEST(SkinFriction, IsAbsentWhenSwitchedOffOrWithoutViscosityOrDensity) {
  const FaceTable ball = ballFaces(1);
  const Twist x{{10, -20, 5}, {3, 1, -2}};
  LoadSettings off = ballSettings(1);
  off.skin_friction = false;
  LoadSettings inviscid = ballSettings(1);
  inviscid.viscosity = 0;
  LoadSettings vacuum = ballSettings(1);
  vacuum.density = 0;
  for (const LoadSettings& settings : {off, inviscid, vacuum})
    EXPECT_EQ(computeFaceLoads(ball, kLength, x, settings).friction.vector(), Vector6::Zero());
}

TEST(SkinFriction, LeavesThePressureAsItIs) {
  const FaceTable ball = ballFaces(2);
  const Twist x{{10, -20, 5}, {3, 1, -2}};
  for (const double angle : {1.0, 1.5}) {
    LoadSettings off = ballSettings(angle);
    off.skin_friction = false;
    EXPECT_EQ(computeFaceLoads(ball, kLength, x, off).pressure.vector(),
              computeFaceLoads(ball, kLength, x, ballSettings(angle)).pressure.vector());
  }
}

}  // namespace
}  // namespace ambient::skin_friction

namespace ambient {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

double relativeError(double x) {
  const long double exact = std::pow(static_cast<long double>(x), -0.2L);
  return static_cast<double>(std::abs(reynoldsPower(x) / exact - 1));
}

TEST(InverseFifthRoot, IsThePowerToOneUnitInTheLastPlace) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::exp2(arbitrary.between(-1022, 1023.99));
    ASSERT_LE(relativeError(x), kUlp) << x;
  }
}

TEST(InverseFifthRoot, IsAsGoodWithinEveryOctaveOfItsArgument) {
  // Five octaves are one period of the initial guess.
  for (int i = 0; i < 5 * 4096; ++i) {
    const double x = std::ldexp(1 + (i % 4096) / 4096.0, i / 4096);
    ASSERT_LE(relativeError(x), kUlp) << x;
  }
}

TEST(InverseFifthRoot, ReachesTheEndsOfTheNormalRange) {
  for (const double x :
       {std::numeric_limits<double>::min(), std::numeric_limits<double>::max(), 1.0})
    EXPECT_LE(relativeError(x), kUlp) << x;
}

TEST(InverseFifthRoot, OfZeroIsFiniteSoThatNoSlipMeansNoFriction) {
  const double r = reynoldsPower(0.0);
  EXPECT_TRUE(std::isfinite(r * r * r));
  EXPECT_EQ(0.0 * (r * r * r), 0);
}

TEST(InverseFifthRoot, OfSubnormalNumbersIsPositiveAndFinite) {
  for (const double x :
       {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::min() / 3}) {
    EXPECT_GT(reynoldsPower(x), 0);
    EXPECT_TRUE(std::isfinite(reynoldsPower(x)));
  }
}

}  // namespace
}  // namespace ambient
