#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "tests/reference/kirchhoff_motion.h"
#include "tests/support/bodies/ellipsoid_body.h"
#include "tests/support/bodies/free_body.h"

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

}  // namespace
}  // namespace ambient
