#include "bullet_ambient/force/law/viscous_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/law/skin_friction.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "tests/reference/loads/sphere_loads.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"

// Numbers of docs/theory.md section 19 from a program of their own, to their digits.

namespace ambient {
namespace {

/// Whole load on a ball of radius 0.5 m in a fluid of density 1 at |v| = 1 m/s.
struct Coefficients {
  double drag, lift, moment;
};
Coefficients coefficientsAt(double reynolds, double relative_roughness = 0, double spin = 0) {
  const double radius = 0.5;
  const ViscousFluid fluid{1, 2 * radius / reynolds, 2 * radius * relative_roughness};
  const Twist x{{0, 0, spin / radius}, {1, 0, 0}};
  const BallLoad load = computeBallLoad(radius, fluid, x);
  const Wrench whole =
      load.pressure + load.layer + ballResistance(radius, fluid.viscosity).load(load.growth, x);
  const double force = 0.5 * kPi * radius * radius;
  return {-whole.force.x() / force, whole.force.y() / force, -whole.torque.z() / (force * radius)};
}

void expectDigits(double value, double expected, int digits = 5) {
  EXPECT_NEAR(value, expected,
              0.51 * std::pow(10.0, std::floor(std::log10(expected)) - digits + 1));
}

TEST(BallLaw, DragOfASmoothBallHasItsNumbers) {
  const double expected[][2] = {{0.1, 244.14},  {1, 27.240},    {10, 4.3087},   {100, 1.0767},
                                {500, 0.55896}, {1e3, 0.46165}, {3e3, 0.38772}, {1e4, 0.41114},
                                {3e4, 0.46998}, {1e5, 0.49568}, {2e5, 0.49776}, {3.3e5, 0.25243},
                                {5e5, 0.11840}, {1e6, 0.12223}, {2e6, 0.13534}, {6e6, 0.15196}};
  for (const auto& [reynolds, drag] : expected) {
    SCOPED_TRACE(reynolds);
    expectDigits(coefficientsAt(reynolds).drag, drag);
  }
}

TEST(BallLaw, RoughnessBringsTheCrisisForward) {
  expectDigits(coefficientsAt(3e4, 5e-3).drag, 0.46998);
  expectDigits(coefficientsAt(1e5, 5e-3).drag, 0.23285);
  expectDigits(coefficientsAt(1e6, 5e-3).drag, 0.30630);
  EXPECT_GT(coefficientsAt(1e5, 0).drag, 0.47);
}

TEST(BallLaw, StateOfTheLayersHasItsNumbers) {
  const struct {
    double reynolds, rough, turbulent, from_nose, roughness, suction, share;
  } rows[] = {{3.3e5, 0, 0.51745, 0.02779, 1, 0.7898, 0.9974},
              {1e6, 0, 1, 0.20793, 1, 0.6053, 0.9995},
              {1e5, 5e-3, 0.99650, 0.91719, 1.5914, 0.7133, 0.9847}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.reynolds);
    const LayerState layers = layerState(0.3578988, row.reynolds, row.rough);
    EXPECT_NEAR(layers.turbulent, row.turbulent, 1e-5);
    EXPECT_NEAR(layers.from_nose, row.from_nose, 1e-5);
    EXPECT_NEAR(layers.roughness, row.roughness, 1e-4);
    const BallLoad ball =
        computeBallLoad(0.5, {1, 1 / row.reynolds, row.rough}, {{0, 0, 0}, {1, 0, 0}});
    EXPECT_NEAR(ball.suction, row.suction, 1e-4);
    EXPECT_NEAR(ball.share, row.share, 1e-4);
  }
}

TEST(BallLaw, SpinLiftsAndBrakes) {
  const double golf = 0.2 / 42.7;
  const struct {
    double reynolds, roughness, spin, drag, lift, moment;
  } rows[] = {{1.5e5, golf, 0.1, 0.26199, 0.17753, 0.002293},
              {1.5e5, golf, 0.3, 0.29097, 0.26930, 0.006945},
              {2e4, 0, 0.5, 0.52711, 0.32402, 0.015132},
              {9e4, 0, 0.3, 0.49890, 0.075309, 0.004164}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.reynolds);
    const Coefficients got = coefficientsAt(row.reynolds, row.roughness, row.spin);
    expectDigits(got.drag, row.drag);
    expectDigits(got.lift, row.lift);
    expectDigits(got.moment, row.moment, 4);
  }
}

TEST(BallLaw, TurningInPlaceHasItsMoment) {
  const double expected[][2] = {{1, 50.336},    {10, 5.5065},    {100, 0.96250},
                                {1e3, 0.23449}, {4e4, 0.032793}, {1e6, 0.0082588}};
  for (const auto& [reynolds, moment] : expected) {
    SCOPED_TRACE(reynolds);
    const ViscousFluid fluid{1, 1 / reynolds, 0};
    const Twist x{{0, 0, 1}, {0, 0, 0}};
    const BallLoad load = computeBallLoad(1, fluid, x);
    const Wrench whole =
        load.pressure + load.layer + ballResistance(1, fluid.viscosity).load(load.growth, x);
    expectDigits(-2 * whole.torque.z(), moment);
  }
}

TEST(BallLaw, WrenchesInWaterHaveTheirNumbers) {
  const Twist x{{3, -2, 5}, {1, 2, -1}};
  const auto wrench = [&](double viscosity, double roughness) {
    const BallLoad load = computeBallLoad(0.1, {1000, viscosity, roughness}, x);
    return load.pressure + load.layer + ballResistance(0.1, viscosity).load(load.growth, x);
  };
  const Wrench smooth = wrench(1e-3, 0), rough = wrench(1e-3, 2e-4), ideal = wrench(0, 0);
  EXPECT_LT((smooth.torque - Vector3(-0.0071625, 0.004775, -0.011938)).norm(), 1e-6);
  EXPECT_LT((smooth.force - Vector3(-19.452, 0.94181, 19.452)).norm(), 1e-3);
  EXPECT_LT((rough.force - Vector3(-22.610, -5.3721, 22.610)).norm(), 1e-3);
  EXPECT_LT((ideal.force - Vector3(-34.126, -28.404, 34.126)).norm(), 1e-3);
  EXPECT_EQ(ideal.torque, Vector3(0, 0, 0));
}

TEST(BallLaw, NoForceIsLeftAsTheSpeedGoes) {
  for (const double viscosity : {0.0, 1e-3, 1.0})
    for (const double spin : {1.0, 100.0}) {
      const auto force = [&](double speed) {
        const Twist x{{0, spin, 0.3 * spin}, {speed, 0, 0}};
        const BallLoad load = computeBallLoad(0.1, {1000, viscosity, 0}, x);
        return (load.pressure + load.layer + ballResistance(0.1, viscosity).load(load.growth, x))
            .force.norm();
      };
      EXPECT_LT(force(1e-6), 1.1e-3 * force(1e-3));
      EXPECT_EQ(force(0), 0);
    }
}

TEST(BallLaw, IsPassiveAtAnyReynoldsNumber) {
  for (const double viscosity : {0.0, 1e-8, 1e-3, 1.0, 1e3})
    for (const double speed : {1e-6, 1e-2, 1.0, 300.0})
      for (const double spin : {0.0, 1e-3, 10.0, 1e4})
        for (const double roughness : {0.0, 1e-3}) {
          const Twist x{{0.1 * spin, spin, 0.3 * spin}, {speed, 0.2 * speed, 0}};
          const BallLoad load = computeBallLoad(0.1, {1000, viscosity, roughness}, x);
          const Wrench whole =
              load.pressure + load.layer + ballResistance(0.1, viscosity).load(load.growth, x);
          EXPECT_LE(power(whole, x), 0);
          EXPECT_TRUE(whole.vector().allFinite());
        }
}

namespace skin_friction {

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

}  // namespace skin_friction

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
