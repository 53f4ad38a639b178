#include "preprocess/resistance/stokes_resistance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/surface/panel_views.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"
#include "tests/reference/ellipsoid_added_mass.h"

namespace ambient {
namespace {

using Eigen::Vector3d;
using test::differenceOf;
using test::relativeError;
using test::skewBody;

TriangleMesh ellipsoid(const Vector3d& semi_axes, int faces) {
  return withVolume(makeEllipsoidMesh(semi_axes, faces), 4 * kPi / 3 * semi_axes.prod());
}

Matrix6 sheetResistance(const TriangleMesh& mesh, int panels = 300) {
  StokesSettings settings;
  settings.sheet = true;
  settings.panels = panels;
  return computeStokesResistance(mesh, settings);
}

/// Largest relative error of the diagonal.
double diagonalError(const Matrix6& R, const Vector6& reference) {
  return ((R.diagonal() - reference).array() / reference.array()).abs().maxCoeff();
}

TEST(EllipsoidResistance, HasItsKnownValues) {
  // Sphere: Stokes and Kirchhoff. Disc of radius 1: 32/3 about any axis and edge-on, 16 broadside
  // (Lamb, art. 339).
  EXPECT_LT((ellipsoidResistance({1, 1, 1}) - sphereResistance(1)).cwiseAbs().maxCoeff(),
            1e-13 * 8 * kPi);
  Vector6 disc;
  disc << 32.0 / 3, 32.0 / 3, 32.0 / 3, 32.0 / 3, 32.0 / 3, 16;
  EXPECT_LT((ellipsoidResistance({1, 1, 0}) - disc).cwiseAbs().maxCoeff(), 1e-12);
  // Five digits, from the prototype of the law.
  Vector6 prolate, scalene;
  prolate << 40.548, 75.646, 75.646, 22.694, 25.992, 25.992;
  scalene << 263.99, 253.45, 152.77, 41.560, 36.597, 33.822;
  EXPECT_LT(((ellipsoidResistance({2, 1, 1}) - prolate).array() / prolate.array()).abs().maxCoeff(),
            2e-5);
  EXPECT_LT(((ellipsoidResistance({1, 2, 3}) - scalene).array() / scalene.array()).abs().maxCoeff(),
            2e-5);
}

TEST(EllipsoidResistance, IsThatOfTheIntegralsByQuadrature) {
  for (const Vector3d& a : {Vector3d(2, 1, 1), Vector3d(0.3, 2, 5), Vector3d(1, 1, 0.1)}) {
    const Vector6 R = ellipsoidResistance(a), reference = reference::ellipsoidResistance(a);
    EXPECT_LT(((R - reference).array() / reference.array()).abs().maxCoeff(), 1e-9)
        << a.transpose();
  }
}

/// Of a panel, at up to eight points.
std::vector<Eigen::Matrix3d> stokesletsOf(const Panel& panel, const std::vector<Vector3d>& points) {
  PanelPoints seen;
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < 8; ++i)
      seen.at[axis][i] = points[std::min(i, points.size() - 1)][axis];
  PanelTensors found;
  kViewStokeslets.fastest()(numbersOf(panel), seen, 8, found);
  std::vector<Eigen::Matrix3d> tensors(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto at = [&](int component) { return found.at[component][i]; };
    tensors[i] << at(0), at(3), at(4), at(3), at(1), at(5), at(4), at(5), at(2);
  }
  return tensors;
}

TEST(Stokeslets, OfAPanelAreThoseOfPoints) {
  const Panel panel = makePanel({0, 0, 0.1}, {1, 0.2, 0}, {0.3, 0.9, -0.2});
  const std::vector<Vector3d> points = {
      {0.4, 0.3, 0.5}, {-1, 2, -0.7}, {3, 1, 0.2}, {0.5, 0.4, -0.3}};
  const std::vector<Eigen::Matrix3d> tensors = stokesletsOf(panel, points);
  constexpr int kCuts = 200;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();  // midpoints of kCuts^2 small triangles
    for (int a = 0; a < kCuts; ++a)
      for (int b = 0; b < kCuts - a; ++b)
        for (int up = 0; up < (b < kCuts - a - 1 ? 2 : 1); ++up) {
          const double u = (a + (up + 1) / 3.0) / kCuts, v = (b + (up + 1) / 3.0) / kCuts;
          const Vector3d r = points[i] - panel.at({1 - u - v, u, v});
          sum += Eigen::Matrix3d::Identity() / r.norm() + r * r.transpose() / std::pow(r.norm(), 3);
        }
    sum *= panel.area / (kCuts * kCuts);
    EXPECT_LT((tensors[i] - sum).cwiseAbs().maxCoeff(), 2e-5 * sum.cwiseAbs().maxCoeff()) << i;
  }
}

TEST(Stokeslets, OnThePanelAreThoseOfItsParts) {
  // The tensor at the centroid is the sum over the three triangles around it, and at a corner
  // finite.
  const Panel panel = makePanel({0, 0, 0.1}, {1, 0.2, 0}, {0.3, 0.9, -0.2});
  const Eigen::Matrix3d whole = stokesletsOf(panel, {panel.centroid})[0];
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k)
    sum += stokesletsOf(makePanel(panel.corner[k], panel.corner[(k + 1) % 3], panel.centroid),
                        {panel.centroid})[0];
  EXPECT_LT((whole - sum).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_TRUE(stokesletsOf(panel, {panel.corner[1]})[0].allFinite());
}

TEST(StokesResistance, OfEllipsoidsIsTheClosedForm) {
  struct Body {
    Vector3d semi_axes;
    double error;  // measured on 320 panels of the true volume, rounded up
  };
  for (const Body& body : {Body{{1, 1, 1}, 2e-4}, Body{{2, 1, 1}, 4e-4}, Body{{1, 1, 5}, 1.2e-3},
                           Body{{1, 2, 3}, 1e-3}, Body{{1, 1, 0.2}, 3e-3}}) {
    const Matrix6 R = computeStokesResistance(ellipsoid(body.semi_axes, 320));
    EXPECT_LT(diagonalError(R, ellipsoidResistance(body.semi_axes)), body.error)
        << body.semi_axes.transpose();
  }
}

TEST(StokesResistance, ConvergesWithTheSizeOfPanels) {
  std::vector<double> error;
  for (const int faces : {80, 320, 1280}) {
    StokesSettings settings;
    settings.panels = faces;
    error.push_back(diagonalError(computeStokesResistance(ellipsoid({2, 1, 1}, faces), settings),
                                  ellipsoidResistance({2, 1, 1})));
  }
  EXPECT_GT(error[0] / error[1], 3);
  EXPECT_GT(error[1] / error[2], 1.8);
}

TEST(StokesResistance, OfEdgedBodiesIsAsMeasuredAndComputedElsewhere) {
  // Cube of edge 1: 12.69 and 8.00 on 432 panels; finer ones 12.70 and 8.03. Pettyjohn and
  // Christiansen 1948 measured 6 pi 0.673. Cylinder of length and diameter 1 on 308 panels: 11.33
  // along, 11.42 across; 5.02, 6.08.
  const Matrix6 cube = computeStokesResistance(makeBoxMesh({0.5, 0.5, 0.5}, {1, 1, 1}));
  EXPECT_NEAR(cube(3, 3) / 12.70, 1, 0.005);
  EXPECT_NEAR(cube(0, 0) / 8.03, 1, 0.01);
  EXPECT_NEAR(cube(3, 3) / (6 * kPi * 0.673), 1, 0.005);
  const Matrix6 cylinder =
      computeStokesResistance(withVolume(makeCylinderMesh(0.5, 1, 400), kPi / 4));
  EXPECT_NEAR(cylinder(5, 5) / 11.33, 1, 0.01);
  EXPECT_NEAR(cylinder(3, 3) / 11.42, 1, 0.01);
  EXPECT_NEAR(cylinder(2, 2) / 5.02, 1, 0.02);
  EXPECT_NEAR(cylinder(0, 0) / 6.08, 1, 0.02);
}

TEST(StokesResistance, OfSheetsIsThatOfDiscsAndPlates) {
  // Constant forces on panels do not know the infinite ones at the rim: 0.2 % in translation, 0.9 %
  // in rotation.
  const Matrix6 disc = sheetResistance(makeEllipticSheetMesh(1, 1, 264));
  EXPECT_NEAR(disc(5, 5) / 16, 1, 0.01);
  EXPECT_NEAR(disc(3, 3) / (32.0 / 3), 1, 0.01);
  EXPECT_NEAR(disc(0, 0) / (32.0 / 3), 1, 0.03);
  EXPECT_NEAR(disc(2, 2) / (32.0 / 3), 1, 0.03);
  // Square of edge 1, by 200 panels of the prototype.
  const Matrix6 square = sheetResistance(makeRectangularSheetMesh(1, 1, 300));
  EXPECT_NEAR(square(3, 3) / 6.15, 1, 0.01);
  EXPECT_NEAR(square(5, 5) / 9.18, 1, 0.01);
}

TEST(StokesResistance, OfTwoBallsThatTouchIsTheirsByBispherical) {
  // 0.6451 and 0.7243 of both alone (Happel and Brenner 1965; from memory).
  TriangleMesh above = ellipsoid({1, 1, 1}, 320), below = above;
  const double gap = above.extents().z() / 2 + 1e-3;  // corners of the polyhedra stand out by 1 %
  above.vertices.row(2).array() += gap;
  below.vertices.row(2).array() -= gap;
  StokesSettings settings;
  settings.panels = 640;
  const Matrix6 R = computeStokesResistance(joinMeshes({above, below}), settings);
  EXPECT_NEAR(R(5, 5) / (12 * kPi * 0.6451), 1, 0.01);
  EXPECT_NEAR(R(3, 3) / (12 * kPi * 0.7243), 1, 0.01);
}

TEST(StokesResistance, OfTwoBoxesAtANarrowGapIsThatOfOne) {
  // The gap is far narrower than the panels on both sides of it.
  for (const double gap : {1e-2, 1e-3, 1e-6}) {
    TriangleMesh one = makeBoxMesh({0.5, 0.5, 0.5}, 12), other = one;
    other.vertices.row(0).array() += 1 + gap;
    TriangleMesh both = joinMeshes({one, other});
    both.vertices.row(0).array() -= 0.5;
    const Matrix6 R = computeStokesResistance(both),
                  whole = computeStokesResistance(makeBoxMesh({1, 0.5, 0.5}, 12));
    EXPECT_LT(diagonalError(R, whole.diagonal()), 0.02) << gap;
  }
}

TEST(StokesResistance, TurnsMovesAndScalesWithTheBody) {
  const TriangleMesh body = skewBody(makeBoxMesh({0.5, 0.4, 0.8}, 200));
  const Matrix6 R = computeStokesResistance(body);
  const Vector3d move(3, -2, 1);
  TriangleMesh other = body;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  other.vertices = (2.5 * (turn * body.vertices)).colwise() + move;
  const Matrix6 expected = shiftOrigin(rotateAxes(scaleResistance(R, 2.5), turn), -move);
  EXPECT_LT(differenceOf(computeStokesResistance(other), expected, 3), 1e-9);
}

TEST(StokesResistance, IsSymmetricPositiveAndTheSameOnAnyNumberOfThreads) {
  const TriangleMesh body = skewBody(makeBoxMesh({0.5, 0.4, 0.8}, 200));
  StokesSettings settings;
  settings.threads = 1;
  const Matrix6 one = computeStokesResistance(body, settings);
  settings.threads = 3;
  EXPECT_TRUE((one.array() == computeStokesResistance(body, settings).array()).all());
  EXPECT_TRUE(isSymmetric(one));
  EXPECT_GT(symmetricEigen<6>(one).values[0], 0);
}

TEST(StokesResistance, OfFineMeshesIsThatOfCoarseOnes) {
  // 5120 triangles become 300.
  const Matrix6 fine = computeStokesResistance(ellipsoid({1, 2, 3}, 5120));
  EXPECT_LT(diagonalError(fine, ellipsoidResistance({1, 2, 3})), 3e-3);
  // A sheet keeps its panels and gets groups of them.
  const Matrix6 disc = sheetResistance(makeEllipticSheetMesh(1, 1, 3000));
  EXPECT_NEAR(disc(5, 5) / 16, 1, 0.01);
  EXPECT_NEAR(disc(3, 3) / (32.0 / 3), 1, 0.01);
  EXPECT_NEAR(disc(0, 0) / (32.0 / 3), 1, 0.03);
}

TEST(CentreOfReaction, MakesTheCouplingSymmetric) {
  const Matrix6 R = computeStokesResistance(skewBody(makeBoxMesh({0.5, 0.4, 0.8}, 200)));
  const Matrix6 about = shiftOrigin(R, centreOfReaction(R));
  const Eigen::Matrix3d coupling = about.bottomLeftCorner<3, 3>();
  EXPECT_LT((coupling - coupling.transpose()).cwiseAbs().maxCoeff(),
            1e-12 * R.cwiseAbs().maxCoeff());
  // A ball beside the origin has its centre.
  const Vector3d centre(0.3, -2, 5);
  const Matrix6 ball = shiftOrigin(Matrix6(sphereResistance(0.2).asDiagonal()), -centre);
  EXPECT_LT((centreOfReaction(ball) - centre).norm(), 1e-13);
}

TEST(StokesResistance, RefusesAMeshWithoutTriangles) {
  EXPECT_THROW(computeStokesResistance(TriangleMesh{}), std::runtime_error);
}

}  // namespace
}  // namespace ambient
