#include "bullet_ambient/force/law/skin_friction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "tests/reference/loads/sphere_loads.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/convergence.h"

namespace ambient::skin_friction {
namespace {

// Golf ball in air; its launch speed and spin.
const reference::SphereInFluid kBall{0.02135, 1.204, 1.82e-5};
constexpr double kSpeed = 53;
const double kSpin = 42 * 2 * std::acos(-1.0);
constexpr int kDirections = 16;

LoadSettings ballSettings(double angle_in_right_angles) {
  return {kBall.density, kBall.viscosity, separationCosine(angle_in_right_angles * kPi / 2), true};
}

FaceTable ballFaces(int level) {
  return test::faceTableOf(test::geodesicEllipsoid(Vector3::Constant(kBall.radius), level));
}

const double kLength = std::sqrt(4 * kPi) * kBall.radius;

/// Root mean square over directions of (drag / expected - 1).
double dragError(int level, double angle, double expected) {
  const FaceTable ball = ballFaces(level);
  test::Arbitrary arbitrary(3);
  return test::rootMeanSquare(kDirections, [&](int) {
    const Vector3 direction = arbitrary.vector().normalized();
    const FaceLoads loads =
        computeFaceLoads(ball, kLength, {Vector3::Zero(), kSpeed * direction}, ballSettings(angle));
    return -loads.friction.force.dot(direction) / expected - 1;
  });
}

TEST(SphereFrictionReference, HasTheTabulatedValues) {
  EXPECT_NEAR(reference::sphereFrictionDrag(kBall, kSpeed, kPi / 2), 0.01382554906, 1e-11);
  EXPECT_NEAR(reference::sphereFrictionDrag(kBall, kSpeed, 0.75 * kPi), 0.02651367823, 1e-11);
  EXPECT_NEAR(reference::sphereFrictionTorque(kBall, kSpin), 1.0444853816e-05, 1e-15);
}

TEST(SkinFriction, DragsTheSphereAsInTheClosedForm) {
  for (const double angle : {1.0, 1.5}) {
    const double expected = reference::sphereFrictionDrag(kBall, kSpeed, angle * kPi / 2);
    const test::Convergence c = test::measureConvergence(
        1, 5, [=](int level) { return dragError(level, angle, expected); });
    EXPECT_GT(c.order(), 1.4) << angle;  // the friction jumps at the separation line
    EXPECT_LT(c.finest(), 2.5e-3) << angle;
  }
}

TEST(SkinFriction, BrakesTheSpinOfASphereInPlaceAsInTheClosedForm) {
  const double expected = reference::sphereFrictionTorque(kBall, kSpin);
  const test::Convergence c = test::measureConvergence(1, 5, [=](int level) {
    const FaceTable ball = ballFaces(level);
    test::Arbitrary arbitrary(4);
    return test::rootMeanSquare(kDirections, [&](int) {
      const Vector3 axis = arbitrary.vector().normalized();
      const FaceLoads loads =
          computeFaceLoads(ball, kLength, {kSpin * axis, Vector3::Zero()}, ballSettings(1.2));
      return -loads.friction.torque.dot(axis) / expected - 1;
    });
  });
  EXPECT_NEAR(c.order(), 2, 0.1);  // attached everywhere: no separation line
  EXPECT_LT(c.finest(), 1.2e-3);   // measured 1.0e-3
}

TEST(SkinFriction, GrowsWithThePower1Point8OfTheSpeed) {
  const FaceTable ball = ballFaces(2);
  const Twist slow{{10, -20, 5}, {3, 1, -2}};
  const Twist fast{7 * slow.angular, 7 * slow.linear};
  const Wrench before = computeFaceLoads(ball, kLength, slow, ballSettings(1.2)).friction;
  const Wrench after = computeFaceLoads(ball, kLength, fast, ballSettings(1.2)).friction;
  const double factor = std::pow(7, 1.8);
  EXPECT_LT((after.vector() - factor * before.vector()).norm(), 1e-13 * after.vector().norm());
}

TEST(SkinFriction, FallsWithTheFifthRootOfTheReynoldsNumber) {
  const FaceTable ball = ballFaces(2);
  const Twist x{{10, -20, 5}, {3, 1, -2}};
  LoadSettings thick = ballSettings(1);
  thick.viscosity *= 32;
  const Vector6 thin_load = computeFaceLoads(ball, kLength, x, ballSettings(1)).friction.vector();
  const Vector6 thick_load = computeFaceLoads(ball, kLength, x, thick).friction.vector();
  const Vector6 longer = computeFaceLoads(ball, 32 * kLength, x, ballSettings(1)).friction.vector();
  EXPECT_LT((thick_load - 2 * thin_load).norm(), 1e-13 * thick_load.norm());
  EXPECT_LT((longer - 0.5 * thin_load).norm(), 1e-13 * longer.norm());
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
