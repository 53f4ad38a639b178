#include <gtest/gtest.h>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "tests/reference/loads/sphere_loads.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/convergence.h"

namespace ambient {
namespace {

namespace plate {

// Rounding of a sum of a few hundred terms of similar size.
constexpr double kRounding = 1e-13;
constexpr double kDensity = 1.3;
constexpr double kSpeed = 4;

void addBothSides(FaceTable& faces, const Vector3& centroid, double area) {
  faces.add({0, 0, 1}, centroid, area);
  faces.add({0, 0, -1}, centroid, area);
}

/// Rectangle of 3 m by 2 m in the x-y plane, cut into squares; both sides.
FaceTable plateFaces() {
  FaceTable faces;
  constexpr double kSize = 0.25;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 8; ++j)
      addBothSides(faces, {(i - 5.5) * kSize, (j - 3.5) * kSize, 0}, kSize * kSize);
  return faces;
}
constexpr double kPlateArea = 6;

/// Disk of radius a in the x-y plane, cut along circles and diameters; both sides.
FaceTable diskFaces(double a) {
  FaceTable faces;
  constexpr int kRings = 5;
  constexpr int kSectors = 24;
  const double half_angle = kPi / kSectors;
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double inner = a * ring / kRings;
      const double outer = a * (ring + 1) / kRings;
      const double area = half_angle * (outer * outer - inner * inner);
      // Exact barycentre of a sector of a ring.
      const double distance =
          2.0 / 3 * std::sin(half_angle) * (outer * outer * outer - inner * inner * inner) / area;
      const double angle = (2 * sector + 1) * half_angle;
      addBothSides(faces, {distance * std::cos(angle), distance * std::sin(angle), 0}, area);
    }
  return faces;
}

Wrench pressureOn(const FaceTable& faces, const Twist& twist, double separation_angle) {
  const LoadSettings settings{kDensity, 0, separationCosine(separation_angle), false};
  return computeFaceLoads(faces, 1, twist, settings).pressure;
}

/// Velocity of a plate that moves along x at incidence i: its side +z is windward.
Vector3 velocityAt(double incidence) {
  return kSpeed * Vector3(std::cos(incidence), 0, std::sin(incidence));
}

TEST(PlatePressure, FollowsTheClosedFormsOfLiftAndDragAtEveryIncidence) {
  const FaceTable plate = plateFaces();
  const double unit = 0.5 * kDensity * kSpeed * kSpeed * kPlateArea;
  for (int degrees = 1; degrees <= 90; ++degrees) {
    const double i = degrees * kPi / 180;
    const Wrench f = pressureOn(plate, {Vector3::Zero(), velocityAt(i)}, kPi / 2);
    const reference::PlateCoefficients expected = reference::plateAtIncidence(i, kPi / 2);
    const Vector3 along = velocityAt(i).normalized();
    const Vector3 across(std::sin(i), 0, -std::cos(i));
    EXPECT_NEAR(f.force.z() / unit, -expected.normal, kRounding) << degrees;
    EXPECT_NEAR(-f.force.dot(along) / unit, expected.drag, kRounding) << degrees;
    EXPECT_NEAR(f.force.dot(across) / unit, expected.lift, kRounding) << degrees;
    EXPECT_LT(f.torque.norm() / unit, kRounding) << degrees;  // pressure acts at the centroid
  }
}

TEST(PlatePressure, VanishesBroadside) {
  const Wrench f = pressureOn(plateFaces(), {Vector3::Zero(), {0, 0, kSpeed}}, kPi / 2);
  EXPECT_EQ(f.vector(), Vector6::Zero());
}

TEST(PlatePressure, VanishesExactlyEdgeOnAndJumpsToFullPressureBesideIt) {
  const FaceTable plate = plateFaces();
  EXPECT_EQ(pressureOn(plate, {Vector3::Zero(), {kSpeed, 0, 0}}, kPi / 2).vector(),
            Vector6::Zero());
  const Wrench beside = pressureOn(plate, {Vector3::Zero(), velocityAt(1e-9)}, kPi / 2);
  EXPECT_NEAR(beside.force.z(), -0.5 * kDensity * kSpeed * kSpeed * kPlateArea, 1e-12);
}

TEST(PlatePressure, StaysBalancedUntilTheLeeSideSeparates) {
  const FaceTable plate = plateFaces();
  const double unit = 0.5 * kDensity * kSpeed * kSpeed * kPlateArea;
  const double alpha = 1.2 * kPi / 2;  // the lee side separates at 18 degrees
  for (const int degrees : {1, 10, 17, 19, 30, 60, 89}) {
    const double i = degrees * kPi / 180;
    const Wrench f = pressureOn(plate, {Vector3::Zero(), velocityAt(i)}, alpha);
    EXPECT_NEAR(f.force.z() / unit, -reference::plateAtIncidence(i, alpha).normal, kRounding)
        << degrees;
  }
}

TEST(DiskPressure, BrakesARotationAboutADiameterWhateverItsRate) {
  constexpr double kRadius = 0.8;
  const FaceTable disk = diskFaces(kRadius);
  const double expected = reference::slidingDiskDamping(kDensity, kSpeed, kRadius);
  // Turns about y while sliding along x: faces end at this diameter, so that the sum is exact.
  for (const double rate : {1e-6, 0.1, -0.1, -3.0}) {
    const Wrench f = pressureOn(disk, {{0, rate, 0}, {kSpeed, 0, 0}}, kPi / 2);
    // Rotation only adds velocity along the plane's normal: |u_s| = V everywhere.
    EXPECT_NEAR(f.torque.y(), -std::copysign(expected, rate), kRounding * expected) << rate;
  }
}

}  // namespace plate

constexpr int kTriangulations = 8;

Wrench pressureOn(const FaceTable& faces, const Vector3& velocity, double angle_in_right_angles) {
  const LoadSettings settings{2, 0, separationCosine(angle_in_right_angles * kPi / 2), false};
  return computeFaceLoads(faces, 1, {Vector3::Zero(), velocity}, settings).pressure;
}

/// Root mean square of error(face table) over triangulations of a geodesic ellipsoid.
template <class Error>
double meanError(const Vector3& semi_axes, int level, const Error& error) {
  test::Arbitrary arbitrary(5);
  return test::rootMeanSquare(kTriangulations, [&](int) {
    return error(
        test::faceTableOf(test::geodesicEllipsoid(semi_axes, level, arbitrary.rotation())));
  });
}

/// Drag coefficient of a spheroid (b, b, a) along its axis z, on the frontal area.
test::Convergence axialDragConvergence(double a, double b) {
  return test::measureConvergence(1, 4, [=](int level) {
    return meanError({b, b, a}, level, [=](const FaceTable& faces) {
      const double frontal_area = kPi * b * b;
      return -pressureOn(faces, {0, 0, 1}, 1).force.z() / frontal_area -
             reference::spheroidDragCoefficient(a, b);
    });
  });
}

TEST(SpheroidReference, HasTheTabulatedCoefficients) {
  EXPECT_NEAR(reference::spheroidDragCoefficient(0.2, 1), 0.0980414854543491, 1e-14);
  EXPECT_NEAR(reference::spheroidDragCoefficient(2, 1), 0.7172025061689375, 1e-14);
}

TEST(SpheroidPressure, OblateOneToFiveConvergesToTheClosedForm) {
  const test::Convergence c = axialDragConvergence(0.2, 1);
  EXPECT_NEAR(c.order(), 2, 0.15);  // measured 2.05
  EXPECT_LT(c.finest(), 2e-4);      // measured 1.2e-4
}

TEST(SpheroidPressure, ProlateTwoToOneConvergesToTheClosedForm) {
  const test::Convergence c = axialDragConvergence(2, 1);
  EXPECT_NEAR(c.order(), 2, 0.15);  // measured 2.0
  EXPECT_LT(c.finest(), 1.2e-3);    // measured 8.5e-4
}

/// Force and torque at density 2 on an ellipsoid at unit speed along (cos i, 0, -sin i).
struct EllipsoidAtIncidence {
  Vector3 semi_axes;
  double angle;      ///< separation angle over pi/2
  double incidence;  ///< i [degrees]
  double force_x, force_z, torque_y;
};

class EllipsoidPressure : public testing::TestWithParam<EllipsoidAtIncidence> {};

TEST_P(EllipsoidPressure, ConvergesToTheSmoothEllipsoid) {
  const EllipsoidAtIncidence& p = GetParam();
  const double i = p.incidence * kPi / 180;
  const Vector3 velocity(std::cos(i), 0, -std::sin(i));
  Vector6 expected;
  expected << 0, p.torque_y, 0, p.force_x, 0, p.force_z;
  const test::Convergence c = test::measureConvergence(1, 4, [&](int level) {
    return meanError(p.semi_axes, level, [&](const FaceTable& faces) {
      return (pressureOn(faces, velocity, p.angle).vector() - expected).norm();
    });
  });
  EXPECT_GT(c.order(), 1.3);  // measured 1.5 to 2: the separation line cuts faces
  // Over the largest load: the area of the body. Measured 0.02 % to 0.2 % with 5120 faces.
  const double area = test::totalArea(test::faceTableOf(test::geodesicEllipsoid(p.semi_axes, 3)));
  EXPECT_LT(c.finest(), 2e-3 * area);
}

// Results of limb-aligned Gauss quadrature (alpha = pi/2, uncertainty 1e-8) and Fibonacci points
// (3e-5) on smooth bodies.
INSTANTIATE_TEST_SUITE_P(
    References, EllipsoidPressure,
    testing::Values(
        EllipsoidAtIncidence{{1, 1, 0.2}, 1, 0, -0.5003277189050727, 0, 0},
        EllipsoidAtIncidence{
            {1, 1, 0.2}, 1, 30, -0.03831223759085936, 2.1569881366057917, 0.22698823654312306},
        EllipsoidAtIncidence{{1, 1, 0.2}, 1, 90, 0, 0.3080064104508175, 0},
        EllipsoidAtIncidence{
            {1, 1, 0.2}, 1.5, 10, -0.026199752580316996, 0.01063231049671106, 0.18844433163466828},
        EllipsoidAtIncidence{
            {1, 1, 0.2}, 1.5, 60, 0.001525881196707004, 0.6997555143653159, 0.39516752450811055},
        EllipsoidAtIncidence{{2, 1, 1}, 1, 0, -2.253158124516771, 0, 0},
        EllipsoidAtIncidence{
            {2, 1, 1}, 1, 30, -1.153872485559386, 3.397464074661239, 0.8693685590911432},
        EllipsoidAtIncidence{{2, 1, 1}, 1, 90, 0, 2.5598162362588535, 0},
        EllipsoidAtIncidence{
            {2, 1, 1}, 1.5, 10, -0.18771998323058456, 0.05933099493203802, 0.7628123146308384},
        EllipsoidAtIncidence{
            {2, 1, 1}, 1.5, 60, -0.15837791771325552, 0.8149325233540612, 1.9523731969845355}));

}  // namespace
}  // namespace ambient
