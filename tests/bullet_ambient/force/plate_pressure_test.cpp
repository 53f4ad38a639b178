#include <gtest/gtest.h>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "tests/reference/loads/sphere_loads.h"

namespace ambient::plate {
namespace {

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

}  // namespace
}  // namespace ambient::plate
