#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient {
namespace {

using Eigen::Vector3d;
using test::addedMassOf;
using test::differenceOf;
using test::sheetAddedMassOf;
using test::skewBody;

// Tolerance: rounding of the factorisation, without discretisation error.
constexpr double kIdentity = 1e-10;

TriangleMesh skewBox() { return skewBody(makeBoxMesh({0.5, 0.35, 0.6}, 300)); }

/// A curved sheet without symmetry.
TriangleMesh skewSheet() { return skewBody(makeRectangularSheetMesh(1.2, 0.8, 200)); }

TEST(FlowInvariance, RotatedMeshGivesRotatedInertia) {
  const Eigen::Matrix3d R = someRotation();
  EXPECT_LT(differenceOf(addedMassOf(rotated(skewBox(), R)), rotateAxes(addedMassOf(skewBox()), R)),
            kIdentity);
  EXPECT_LT(differenceOf(sheetAddedMassOf(rotated(skewSheet(), R)),
                         rotateAxes(sheetAddedMassOf(skewSheet()), R)),
            kIdentity);
}

TEST(FlowInvariance, RotationHoldsForRegularMeshesFullOfEqualDistances) {
  // Rounding must not change the quadrature of any pair of panels.
  const Eigen::Matrix3d R = someRotation();
  for (const TriangleMesh& mesh :
       {makeBoxMesh({1, 1, 1}, 432), makeEllipsoidMesh({1, 1, 1}, 320)}) {
    EXPECT_LT(differenceOf(addedMassOf(rotated(mesh, R)), rotateAxes(addedMassOf(mesh), R)),
              kIdentity);
  }
}

TEST(FlowInvariance, MovedMeshGivesShiftedInertia) {
  const Vector3d d(0.7, -1.3, 2.1);
  // New origin = old origin - d, seen from the moved mesh.
  EXPECT_LT(differenceOf(addedMassOf(moved(skewBox(), d)), shiftOrigin(addedMassOf(skewBox()), -d)),
            kIdentity);
  EXPECT_LT(differenceOf(sheetAddedMassOf(moved(skewSheet(), d)),
                         shiftOrigin(sheetAddedMassOf(skewSheet()), -d)),
            kIdentity);
}

TEST(FlowInvariance, OriginFarAwayCostsOnlyTheDigitsOfTheCoordinates) {
  const Vector3d d(1000, -2000, 3000);
  const Matrix6 near = addedMassOf(skewBox());
  const Matrix6 back = shiftOrigin(addedMassOf(moved(skewBox(), d)), d);
  // Coordinates of 3000 keep 5e-13; the shift back multiplies by 3000 twice.
  EXPECT_LT(differenceOf(addedMassOf(moved(skewBox(), d)), shiftOrigin(near, -d), 3000), kIdentity);
  EXPECT_LT(Matrix3((back - near).bottomRightCorner<3, 3>()).norm(), 1e-9 * near.norm());
}

TEST(FlowInvariance, SizeDoesNotMatter) {
  const Matrix6 unit = addedMassOf(skewBox()), sheet = sheetAddedMassOf(skewSheet());
  for (double s : {1e-6, 0.013, 1e6}) {
    EXPECT_LT(differenceOf(addedMassOf(scaled(skewBox(), s)), scaleShape(unit, s), s), kIdentity)
        << s;
    EXPECT_LT(differenceOf(sheetAddedMassOf(scaled(skewSheet(), s)), scaleShape(sheet, s), s),
              kIdentity)
        << s;
  }
}

TEST(FlowInvariance, MirroredMeshGivesMirroredInertia) {
  // Mirror x -> -x: velocities transform as vectors, rotations (axial) also change sign with the
  // determinant.
  Vector6 signs;
  signs << 1, -1, -1, -1, 1, 1;
  const auto mirror = [](TriangleMesh mesh) {
    mesh.vertices.row(0) *= -1;
    return insideOut(mesh);
  };
  const Matrix6 expected = signs.asDiagonal() * addedMassOf(skewBox()) * signs.asDiagonal();
  EXPECT_LT(differenceOf(addedMassOf(mirror(skewBox())), expected), kIdentity);
  const Matrix6 sheet = signs.asDiagonal() * sheetAddedMassOf(skewSheet()) * signs.asDiagonal();
  EXPECT_LT(differenceOf(sheetAddedMassOf(mirror(skewSheet())), sheet), kIdentity);
}

TEST(FlowInvariance, HandednessOfATwistedBodyIsTheSignOfItsCoupling) {
  const TriangleMesh body = makeEllipsoidMesh({1.2, 0.6, 1.0}, 320);
  const Matrix6 left = addedMassOf(test::twisted(body, -1)),
                right = addedMassOf(test::twisted(body, 1));
  EXPECT_GT(right(0, 3), 0.15);
  EXPECT_NEAR(left(0, 3), -right(0, 3), 1e-3);
}

TEST(FlowInvariance, TurningASheetOverChangesNothing) {
  EXPECT_LT(differenceOf(sheetAddedMassOf(insideOut(skewSheet())), sheetAddedMassOf(skewSheet())),
            kIdentity);
}

TEST(FlowInvariance, PotentialFollowsTheBody) {
  const Eigen::Matrix3d R = someRotation();
  const Vector3d d(0.7, -1.3, 2.1);
  const double s = 0.02;
  const auto here = solvePotentialFlow(skewBox()).potential;
  const auto there = solvePotentialFlow(scaled(moved(rotated(skewBox(), R), d), s)).potential;
  // Unit velocities R e about the origin: v + w x z with z = s (R z' + d).
  const Eigen::Matrix3d v = R.transpose();
  const Eigen::MatrixXd linear = s * here.rightCols<3>() * v;
  const Eigen::MatrixXd angular =
      s * s * (here.leftCols<3>() * v - here.rightCols<3>() * v * crossMatrix(d));
  EXPECT_LT((there.rightCols<3>() - linear).norm(), kIdentity * linear.norm());
  EXPECT_LT((there.leftCols<3>() - angular).norm(), kIdentity * angular.norm());
}

TEST(FlowInvariance, ThreadsDoNotChangeABit) {
  PotentialFlowSettings settings;
  settings.threads = 1;
  const PotentialFlow one = solvePotentialFlow(skewBox(), settings);
  for (int threads : {2, 3, 7}) {
    settings.threads = threads;
    const PotentialFlow many = solvePotentialFlow(skewBox(), settings);
    EXPECT_EQ(many.added_mass, one.added_mass) << threads;
    EXPECT_EQ(many.potential, one.potential) << threads;
    EXPECT_EQ(many.asymmetry, one.asymmetry) << threads;
  }
}

}  // namespace
}  // namespace ambient
