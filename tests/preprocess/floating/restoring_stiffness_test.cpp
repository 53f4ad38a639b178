#include "preprocess/floating/restoring_stiffness.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "bullet_ambient/fluid_body/packed/packed_hull.h"
#include "bullet_ambient/spatial/inertia.h"
#include "tests/support/bodies/hull_bodies.h"

namespace ambient::test {
namespace {

constexpr double kDensityAtSea = 1025, kGravityAtSea = 9.81;

// Energy of water and weight [J] after a displacement by a twist of unit time about `point`.
double energyAfter(const Vector6& twist, const PackedHull& hull, const SurfacePlane& plane,
                   const PointMass& weight, const Vector3& point) {
  const Vector3 turn = twist.head<3>();
  const double angle = turn.norm();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  if (angle > 0) R = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  const Vector3 moved = point + twist.tail<3>() - R * point;
  const SurfacePlane seen = seenFrom(plane, Matrix3(R), moved);
  return hydrostaticEnergy(computeWetVolume(hull, seen), seen) -
         weight.mass * kGravityAtSea * seen.depth(weight.centre);
}

// Second differences of the energy; of six motions, so that the error is of the order of step^2.
Matrix6 secondDifferences(const PackedHull& hull, const SurfacePlane& plane,
                          const PointMass& weight, const Vector3& point) {
  constexpr double kStep = 1e-4;
  const auto energy = [&](int i, int j, double a, double b) {
    return energyAfter(kStep * (a * Vector6::Unit(i) + b * Vector6::Unit(j)), hull, plane, weight,
                       point);
  };
  Matrix6 K;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      K(i, j) =
          (energy(i, j, 1, 1) - energy(i, j, 1, -1) - energy(i, j, -1, 1) + energy(i, j, -1, -1)) /
          (4 * kStep * kStep);
  return K;
}

// A tilted box, its weight anywhere and not that of the water, about any point.
TEST(RestoringStiffness, IsTheSecondDerivativeOfTheEnergy) {
  const PackedHull hull(boxBody({2, 1, 0.6}, 4));
  const SurfacePlane plane{Vector3(0.2, -0.1, 1).normalized(), 0.07, kDensityAtSea, kGravityAtSea};
  const PointMass weight{700, {0.1, -0.05, -0.08}};
  const WetVolume wet = computeWetVolume(hull, plane);
  for (const Vector3& point : {Vector3(0, 0, 0), Vector3(0.4, -0.3, 0.5)}) {
    const Matrix6 K = restoringStiffness(wet, plane, weight, point);
    const Matrix6 differences = secondDifferences(hull, plane, weight, point);
    EXPECT_LT((K - differences).cwiseAbs().maxCoeff(), 1e-6 * K.cwiseAbs().maxCoeff()) << K;
  }
}

// Barge of length L and breadth B: rho g L B in heave, rho g V GM in roll and pitch.
TEST(RestoringStiffness, OfABargeIsThatOfItsMetacentres) {
  const double L = 4, B = 1.5, depth = 1, draught = 0.4, height_of_mass = 0.1;
  const PackedHull hull(boxBody({L, B, depth}));
  const SurfacePlane plane{Vector3::UnitZ(), draught - depth / 2, kDensityAtSea, kGravityAtSea};
  const double volume = L * B * draught;
  const PointMass weight{kDensityAtSea * volume, {0, 0, height_of_mass}};
  const Matrix6 K = restoringStiffness(computeWetVolume(hull, plane), plane, weight, weight.centre);
  const double carried = kDensityAtSea * kGravityAtSea;
  const double lever = draught / 2 - depth / 2 - height_of_mass;  // of buoyancy over weight
  Vector6 expected;
  expected << carried * (L * B * B * B / 12 + volume * lever),
      carried * (L * L * L * B / 12 + volume * lever), 0, 0, 0, carried * L * B;
  EXPECT_LT((K - Matrix6(expected.asDiagonal())).cwiseAbs().maxCoeff(), 1e-9 * expected.maxCoeff());
}

}  // namespace
}  // namespace ambient::test
