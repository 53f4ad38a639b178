#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"
#include "tests/reference/sheet_added_mass.h"

namespace ambient {
namespace {

using reference::SheetAddedMass;
using test::relativeError;
using test::sheetAddedMassOf;

/// Largest relative error; negative if all values lie below the reference.
double sheetError(const Matrix6& K, const SheetAddedMass& exact) {
  const double errors[] = {K(0, 0) / exact.w_x - 1, K(1, 1) / exact.w_y - 1,
                           K(5, 5) / exact.v_z - 1};
  double worst = 0;
  for (double error : errors)
    if (std::abs(error) > std::abs(worst)) worst = error;
  return worst;
}

TEST(SheetFlow, CircularDiskIsALowerBoundThatConvergesQuadratically) {
  std::vector<double> errors;
  for (int faces : {300, 1200}) {
    const TriangleMesh mesh = makeEllipticSheetMesh(1.5, 1.5, faces);
    errors.push_back(sheetError(sheetAddedMassOf(mesh), reference::diskAddedMass(1.5)));
  }
  EXPECT_LT(errors[0], 0);
  EXPECT_LT(errors[1], 0);
  EXPECT_GT(errors[1], -8e-3);  // measured -6.9e-3, part of it the polygon
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.4);
}

TEST(SheetFlow, EllipticDiskIsWithinOnePercent) {
  const Matrix6 K = sheetAddedMassOf(makeEllipticSheetMesh(2, 1, 1200));
  EXPECT_LT(std::abs(sheetError(K, reference::ellipticDisk21AddedMass())), 8e-3);
}

TEST(SheetFlow, RectanglesAreLowerBoundsThatConvergeQuadratically) {
  for (int length : {1, 2, 4}) {
    const SheetAddedMass exact = reference::rectangleAddedMass(length);
    const double coarse =
        sheetError(sheetAddedMassOf(makeRectangularSheetMesh(length, 1, 300)), exact);
    const double fine =
        sheetError(sheetAddedMassOf(makeRectangularSheetMesh(length, 1, 1200)), exact);
    EXPECT_LT(fine, 0) << length;
    EXPECT_GT(fine, -0.012) << length;  // measured -5.4e-3, -7.0e-3, -1.04e-2
    EXPECT_NEAR(coarse / fine, 4, 0.4) << length;
  }
}

TEST(SheetFlow, OnlyBroadsideMotionMovesFluid) {
  Matrix6 K = sheetAddedMassOf(makeRectangularSheetMesh(2, 1, 300));
  const double scale = K.cwiseAbs().maxCoeff();
  for (int i : {0, 1, 5}) K(i, i) = 0;
  EXPECT_LT(K.cwiseAbs().maxCoeff(), 1e-6 * scale);
}

TEST(SheetFlow, PotentialJumpOfADiskIsAnEllipse) {
  // phi(front) - phi(back) = -(4/pi) sqrt(a^2 - r^2) for unit velocity along the normal.
  const TriangleMesh mesh = makeEllipticSheetMesh(1, 1, 1200);
  PotentialFlowSettings settings;
  settings.sheet = true;
  const PotentialFlow flow = solvePotentialFlow(mesh, settings);
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    const double r2 = mesh.vertices.col(v).squaredNorm();
    const double expected = -4 / std::acos(-1.0) * std::sqrt(std::max(0.0, 1 - r2));
    EXPECT_NEAR(flow.potential(v, 5), expected, 0.02) << r2;
  }
  EXPECT_EQ(flow.asymmetry < 1e-14, true);
}

TEST(SheetFlow, IsTheLimitOfThinPlates) {
  // A plate exceeds the sheet in rotational and broadside inertia by an amount proportional to its
  // thickness (with a logarithm).
  const SheetAddedMass exact = reference::rectangleAddedMass(2);
  double previous = 1;
  for (double thickness : {0.1, 0.01, 0.001}) {
    const Matrix6 K = test::addedMassOf(makeBoxMesh({1, 0.5, thickness / 2}, 1200));
    const double error = std::abs(sheetError(K, exact));
    EXPECT_LT(error, 0.35 * previous) << thickness;
    previous = error;
    EXPECT_GT(K(5, 5), 0.99 * exact.v_z);
  }
  EXPECT_LT(previous, 0.01);
}

TEST(SheetFlow, EdgewiseInertiaOfAThinPlateFallsWithTheSquareOfTheThickness) {
  // Edge strips of width h and length L add about L h^2.
  for (double thickness : {0.01, 0.001}) {
    const Matrix6 K = test::addedMassOf(makeBoxMesh({1, 0.5, thickness / 2}, 1200));
    for (int k : {3, 4}) {
      EXPECT_GT(K(k, k), 0.5 * thickness * thickness) << thickness;
      EXPECT_LT(K(k, k), 10 * thickness * thickness) << thickness;
    }
  }
}

TEST(SheetFlow, TwoSheetsFarApartAddUp) {
  const TriangleMesh one = makeRectangularSheetMesh(2, 1, 200);
  const Matrix6 pair = sheetAddedMassOf(joined(one, moved(one, {200, 0, 0})));
  EXPECT_NEAR(pair(5, 5) / sheetAddedMassOf(one)(5, 5), 2, 1e-6);
}

}  // namespace
}  // namespace ambient
