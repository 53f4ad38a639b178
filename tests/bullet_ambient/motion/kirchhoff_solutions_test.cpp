#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "tests/reference/kirchhoff_motion.h"
#include "tests/reference/sphere_fall.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::FreeBody;

constexpr double kWater = 1000;  // [kg/m^3]

// The neutrally buoyant ellipsoid of the reference numbers.
struct Ellipsoid {
  Vector3 semi_axes{0.3, 0.2, 0.1};
  double mass = kWater * test::ellipsoidVolume(semi_axes);
  Vector3 moments = test::ellipsoidMoments(semi_axes, mass);
  Vector6 added = kWater * reference::ellipsoidAddedMass(semi_axes);
  Vector3 total_moments = moments + added.head<3>();
  Vector3 total_masses = Vector3::Constant(mass) + added.tail<3>();

  FreeBody body() const {
    return FreeBody({test::facelessEllipsoid(semi_axes),
                     {mass, moments.asDiagonal()},
                     {kWater, 0, Vector3::Zero(), Vector3::Zero()}});
  }
  reference::PlanarMotion planarMotion(double momentum) const {
    return reference::PlanarMotion::of(total_masses, total_moments.z(), momentum);
  }
};

Quaternion turnedAbout(int axis, double angle) {
  return Quaternion(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)));
}

// Releases a body without spin; y axis at `angle` from the momentum P along the world's y axis.
void release(FreeBody& body, double angle, double momentum) {
  body.state.orientation = turnedAbout(2, angle);
  const Vector3 p = body.state.orientation.conjugate() * Vector3(0, momentum, 0);
  body.state.twist.linear = p.cwiseQuotient(body.model().inertia.diagonal().tail<3>());
}

// Angle about z from the world's y axis to the body's.
double planarAngle(const RigidState& state) {
  const Vector3 y = state.orientation * Vector3(0, 1, 0);
  return std::atan2(-y.x(), y.y());
}

TEST(PlanarMotion, HasTheReferenceFrequencyAndPeriods) {
  // Reference numbers "Kirchhoff rocking, neutrally buoyant ellipsoid", uncertainty 1e-10.
  const Ellipsoid ellipsoid;
  const reference::PlanarMotion motion = ellipsoid.planarMotion(2 * ellipsoid.mass);
  EXPECT_NEAR(motion.frequency, 4.011300635271759, 1e-10);
  EXPECT_NEAR(motion.rockingPeriod(0.1), 1.57029600502, 1e-10);
  EXPECT_NEAR(motion.rockingPeriod(0.5), 1.670275123599, 1e-10);
  EXPECT_NEAR(motion.rockingPeriod(1.0), 2.0815575012, 1e-10);
  EXPECT_NEAR(motion.rockingPeriod(1.4), 3.165329064944, 1e-10);
}

TEST(Leapfrog, RocksLikeTheEllipticFunction) {
  const Ellipsoid ellipsoid;
  const double momentum = 2 * ellipsoid.mass;
  const reference::PlanarMotion motion = ellipsoid.planarMotion(momentum);
  for (const double amplitude : {0.1, 0.5, 1.0, 1.4}) {
    FreeBody body = ellipsoid.body();
    release(body, amplitude, momentum);
    for (int i = 1; i <= 240; ++i) {
      body.advance(1.0 / 60);
      EXPECT_NEAR(planarAngle(body.state), motion.rockingAngle(amplitude, i / 60.0), 1e-11)
          << amplitude << " at step " << i;
    }
  }
}

TEST(Leapfrog, TumblesByHalfATurnInTheReferenceTime) {
  const Ellipsoid ellipsoid;
  const double momentum = 2 * ellipsoid.mass;
  const reference::PlanarMotion motion = ellipsoid.planarMotion(momentum);
  for (const double rate : {4.02, 5.0, 20.0}) {
    FreeBody body = ellipsoid.body();
    release(body, 0, momentum);
    body.state.twist.angular = {0, 0, rate};
    constexpr int kSteps = 64;
    body.advance(motion.tumblingHalfTurn(rate) / kSteps, kSteps);
    // Motion close to the separatrix (4.011 rad/s) amplifies rounding.
    EXPECT_NEAR(std::abs(planarAngle(body.state)), kPi, 1e-10) << rate;
    EXPECT_NEAR(body.state.twist.angular.z(), rate, 1e-9) << rate;
  }
}

struct Growth {
  int moving_axis, turning_axis;
  double reference;  // lambda^2 [1/s^2]
};

// Reference numbers "Kirchhoff translation growth", V = 1 m/s, uncertainty 1e-8.
constexpr Growth kGrowths[] = {{0, 2, 5.651126831285162},  {0, 1, 17.280202446074586},
                               {1, 2, -7.490055530443397}, {1, 0, 41.646305698984925},
                               {2, 1, -68.59780347111813}, {2, 0, -124.73487126824453}};

TEST(Leapfrog, GrowsAndSwingsWithMunksRates) {
  const Ellipsoid ellipsoid;
  const reference::TranslationAlongAxis along{ellipsoid.total_masses, ellipsoid.total_moments, 1.0};
  for (const Growth& growth : kGrowths) {
    SCOPED_TRACE(growth.reference);
    EXPECT_NEAR(along.growth(growth.moving_axis, growth.turning_axis), growth.reference, 1e-8);
    FreeBody body = ellipsoid.body();
    constexpr double kTurn = 1e-6;  // [rad]: sin(theta) = theta to 1e-12
    const Vector3 P = ellipsoid.total_masses[growth.moving_axis] *
                      Vector3(Eigen::Vector3d::Unit(growth.moving_axis));
    body.state.orientation = turnedAbout(growth.turning_axis, kTurn);
    body.state.twist.linear =
        (body.state.orientation.conjugate() * P).cwiseQuotient(ellipsoid.total_masses);
    const double rate = std::sqrt(std::abs(growth.reference));
    constexpr int kSteps = 20;
    body.advance(1.5 / rate / kSteps, kSteps);
    const double angle = 2 * body.state.orientation.vec()[growth.turning_axis];
    const double expected = growth.reference > 0 ? std::cosh(1.5) : std::cos(1.5);
    EXPECT_NEAR(angle / kTurn, expected, 1e-8);
  }
}

TEST(Leapfrog, KeepsAPermanentScrew) {
  const Ellipsoid ellipsoid;
  const Vector3& M = ellipsoid.total_masses;
  const Vector3& I = ellipsoid.total_moments;
  const double lambda = reference::permanentScrew(M[1], M[2], I[1], I[2]);
  FreeBody body = ellipsoid.body();
  const Vector3 p(0, 30, 20);  // any direction in the plane
  body.state.twist = {lambda * p, p.cwiseQuotient(M)};
  const Vector6 twist = body.state.twist.vector();
  body.advance(1.0 / 60, 60);
  // Screw motion is unstable: rounding grows. Measured 2e-14 of |w| = 9.8 rad/s.
  EXPECT_LT((body.state.twist.vector() - twist).norm(), 1e-11);
}

// Largest angle between axis and momentum within 20 s after a release 1e-6 rad off.
double largestDeviation(double spin) {
  // Reference numbers "gyroscopic stability threshold": totals of a body of revolution about z.
  constexpr double I1 = 2, I3 = 1, C = 3, A = 5, P = 4;
  Matrix6 added = Matrix6::Zero();
  added.diagonal() << I1 / 2, I1 / 2, I3 / 2, A - 1, A - 1, C - 1;
  FreeBody body(
      {test::shapeWithoutFaces(added), {1, Vector3(I1 / 2, I1 / 2, I3 / 2).asDiagonal()}});
  body.state.orientation = turnedAbout(0, 1e-6);
  const Vector3 p = body.state.orientation.conjugate() * Vector3(0, 0, P);
  body.state.twist = {{0, 0, spin}, p.cwiseQuotient(Vector3(A, A, C))};
  double largest = 0;
  for (int i = 0; i < 20 * 60; ++i) {
    body.advance(1.0 / 60);
    const Vector3 axis = body.state.orientation * Vector3(0, 0, 1);
    largest = std::max(largest, axis.head<2>().norm());
  }
  return largest;
}

TEST(Leapfrog, IsStableAboveTheLeastSpinOnly) {
  const double least = reference::leastStableSpin(2, 1, 3, 5, 4);
  EXPECT_NEAR(least, 4.131182235954578, 1e-12);  // reference number
  // Linear theory, released 1e-6 off: amplitude 1e-6 / sqrt(1 - (n_c / n)^2) above n_c, 1e-6
  // e^(sigma t) below; sigma = sqrt(n_c^2 - n^2) I3 / (2 I1) = 0.25 / s.
  EXPECT_LT(largestDeviation(1.03 * least), 5e-6);
  EXPECT_GT(largestDeviation(0.97 * least), 3e-5);
}

using reference::SphereFall;
using test::FreeBody;

constexpr double kGravity = 9.81;

FreeBody sphereOf(const SphereFall& fall) {
  FlowSettings flow;
  flow.precision = LoadPrecision::kDouble;  // convergence down to 1e-9
  FreeBody sphere(
      {test::gaussSphere(fall.radius),
       {fall.mass, test::ellipsoidMoments(Vector3::Constant(fall.radius), fall.mass).asDiagonal()},
       {fall.density, 0, Vector3::Zero(), Vector3::Zero()},
       flow});
  sphere.setGravity({0, 0, -kGravity});
  return sphere;
}

constexpr SphereFall kBasketball{0.62, 0.12, 1.204, kGravity};  // in air
constexpr SphereFall kCork{0.05, 0.05, 998, kGravity};          // in water

TEST(SphereFall, HasTheReferenceNumbers) {
  // Reference numbers "sphere vertical fall closed form", uncertainty 1e-9.
  EXPECT_NEAR(kBasketball.terminalSpeed(), 20.985388032787, 1e-9);
  EXPECT_NEAR(kBasketball.settlingTime(), 2.184929401933346, 1e-9);
  EXPECT_NEAR(kBasketball.distance(7.540285264082085), 126.5, 1e-8);
}

// Largest velocity error over the terminal speed, within the settling time.
double largestError(const SphereFall& fall, const FlightSettings& settings, int steps) {
  FreeBody sphere = sphereOf(fall);
  sphere.settings = settings;
  const double step = fall.settlingTime() / steps;
  double largest = 0;
  for (int i = 1; i <= steps; ++i) {
    sphere.advance(step);
    const double error = -sphere.state.twist.linear.z() - fall.velocity(i * step);
    largest = std::max(largest, std::abs(error) / fall.terminalSpeed());
  }
  return largest;
}

TEST(Leapfrog, FallsAndRisesLikeTheClosedFormToSecondOrder) {
  const FlightSettings one_substep{1e-3, 1};
  for (const SphereFall& fall : {kBasketball, kCork}) {
    const double coarse = largestError(fall, one_substep, 25);
    const double fine = largestError(fall, one_substep, 100);
    EXPECT_LT(coarse, 2e-4);
    EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.1);
  }
}

TEST(Leapfrog, StartsWithTheAccelerationOfBodyAndAddedMass) {
  for (const SphereFall& fall : {kBasketball, kCork}) {
    FreeBody sphere = sphereOf(fall);
    constexpr double kStep = 1e-6;
    sphere.advance(kStep);
    EXPECT_NEAR(-sphere.state.twist.linear.z() / kStep, fall.firstAcceleration(),
                1e-9 * std::abs(fall.firstAcceleration()));
  }
}

TEST(Leapfrog, HasATerminalSpeedWithStepsOfAnyLength) {
  // Decay 1/v_2 - 1/v_1 = h / (V_t tau) between two halves of gravity's kick. Fixed point: v^2 =
  // V_t^2 + (g_eff h / 2)^2.
  for (const double ratio : {0.01, 0.1, 1.0, 5.0}) {
    FreeBody ball = sphereOf(kBasketball);
    ball.settings.max_substeps = 1;
    ball.advance(ratio * kBasketball.settlingTime(), 60);
    const double expected = kBasketball.terminalSpeed() * std::hypot(1, ratio / 2);
    const double reached = ratio * 60 > 20 ? 1 : std::tanh(ratio * 60);
    EXPECT_NEAR(-ball.state.twist.linear.z() / expected, reached, 1e-4) << ratio;
  }
}

constexpr double kDiameter = 0.3, kArea = kPi * kDiameter * kDiameter;
constexpr double kVolume = kArea * kDiameter / 6;

Twist along(double speed) { return {Vector3::Zero(), {0, 0, speed}}; }

/// Share at each way in diameters, from rest at a constant speed.
double shareAfter(double diameters, double speed, int steps) {
  Wake wake;
  developWake(along(0), kArea, kVolume, 1, wake);
  const double duration = diameters * kDiameter / speed / steps;
  for (int i = 0; i < steps; ++i) developWake(along(speed), kArea, kVolume, duration, wake);
  return developWake(along(speed), kArea, kVolume, duration, wake);
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
  EXPECT_EQ(developWake(along(3), kArea, kVolume, 0.1, wake), 1);
  EXPECT_EQ(developWake(along(3), kArea, kVolume, 0.1, wake), 1);
  EXPECT_EQ(developWake(along(2.5), kArea, kVolume, 0.1, wake),
            1);  // slower: goes on in its wake
}

TEST(Wake, IsNoneAfterAReversal) {
  Wake wake;
  developWake(along(1), kArea, kVolume, 1, wake);
  EXPECT_EQ(developWake(along(-1), kArea, kVolume, 0.001, wake), 0);
}

TEST(Wake, OfASmallSwingIsNearlyNone) {
  // Amplitude of a tenth of the diameter, a period of 1 s; mean over the work against a drag.
  Wake wake;
  developWake(along(0), kArea, kVolume, 1, wake);
  double work = 0, of_developed = 0;
  for (int i = 0; i < 2400; ++i) {
    const double speed = 0.1 * kDiameter * 2 * kPi * std::sin(2 * kPi * i / 240.0);
    const double share = developWake(along(speed), kArea, kVolume, 1 / 240.0, wake);
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
        developWake(arbitrary.twist(speed, speed), kArea, kVolume, arbitrary.between(0, 1), wake);
    ASSERT_TRUE(share >= 0 && share <= 1) << i << " " << share;
    ASSERT_TRUE(wake.velocity_W.vector().allFinite()) << i;
  }
}

TEST(Wake, TurnsWithTheBody) {
  // A roll has a wake of its own: it needs no way of the centre.
  Wake wake;
  const Twist roll{{2, 0, 0}, Vector3::Zero()};
  developWake(along(0), kArea, kVolume, 1, wake);
  EXPECT_EQ(developWake(roll, kArea, kVolume, 0.1, wake), 0);
  const double way = 2 * 0.1 * kDiameter / 2;
  EXPECT_NEAR(developWake(roll, kArea, kVolume, 0.1, wake),
              std::pow((1 - std::exp(-way / (1.5 * kDiameter))) / 0.7, 2), 1e-12);
}

}  // namespace
}  // namespace ambient
