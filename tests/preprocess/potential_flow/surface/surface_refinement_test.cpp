#include "preprocess/potential_flow/surface/surface_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"
#include "tests/reference/body_added_mass.h"
#include "tests/reference/sheet_added_mass.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient {
namespace {

using test::differenceOf;
using test::relativeError;

constexpr int kFinePanels = 3000;

Matrix6 refinedAddedMassOf(const TriangleMesh& mesh, int panels = kFinePanels, bool sheet = false) {
  PotentialFlowSettings settings;
  settings.sheet = sheet;
  settings.max_panels = panels;
  return solvePotentialFlow(mesh, settings).added_mass;
}

TEST(SurfaceRefinement, KeepsTheSurfaceClosedAndItsShape) {
  for (const TriangleMesh& mesh :
       {makeBoxMesh({1, 0.3, 0.02}, 12), test::gradedTetrahedron(1), makeConeMesh(0.4, 2, 100),
        makeCylinderMesh(1, 1, 200), test::makeTorus({2, 1, 5, 7})}) {
    const TriangleMesh fine = refineSurface(mesh, false, kFinePanels);
    EXPECT_GT(fine.triangleCount(), mesh.triangleCount());
    EXPECT_LE(fine.triangleCount(), kFinePanels);
    EXPECT_NO_THROW(checkMesh(fine, "refined"));
    EXPECT_NEAR(test::volumeOf(fine) / test::volumeOf(mesh), 1, 1e-13);
    EXPECT_NEAR(areaOf(fine) / areaOf(mesh), 1, 1e-13);
    EXPECT_EQ(fine.vertices.leftCols(mesh.vertexCount()), mesh.vertices);
  }
}

TEST(SurfaceRefinement, LeavesFineMeshesAsTheyAre) {
  const TriangleMesh mesh = makeEllipsoidMesh({3, 2, 1}, 1300);
  EXPECT_EQ(refineSurface(mesh, false, kFinePanels).triangleCount(), mesh.triangleCount());
  EXPECT_EQ(refineSurface(makeBoxMesh({1, 1, 1}, 12), false, 0).triangleCount(), 12);
}

TEST(SurfaceRefinement, DivisionKeepsShapeAndVertices) {
  const TriangleMesh box = makeBoxMesh({1, 0.3, 0.02}, 12);
  const TriangleMesh fine = divideTriangles(box, 400);
  EXPECT_GE(fine.triangleCount(), 400);
  EXPECT_LT(fine.triangleCount(), 1600);
  EXPECT_NO_THROW(checkMesh(fine, "divided"));
  EXPECT_NEAR(test::volumeOf(fine) / test::volumeOf(box), 1, 1e-13);
  EXPECT_NEAR(areaOf(fine) / areaOf(box), 1, 1e-13);
  EXPECT_EQ(fine.vertices.leftCols(8), box.vertices);
  EXPECT_EQ(divideTriangles(box, 12).triangleCount(), 12);
}

TEST(SurfaceRefinement, ThinsTrianglesAcrossSharpEdgesButNotAlongThem) {
  const TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 768);
  const TriangleMesh fine = refineSurface(mesh, false, kFinePanels);
  ASSERT_GT(fine.triangleCount(), mesh.triangleCount());
  const auto nearestToAnEdge = [](const TriangleMesh& m, Eigen::Index first) {
    double nearest = 1;
    for (Eigen::Index v = first; v < m.vertexCount(); ++v) {
      Eigen::Array3d inside = 1 - m.vertices.col(v).array().abs();
      std::sort(inside.begin(), inside.end());
      if (inside[1] > 0 || first > 0) nearest = std::min(nearest, inside[1]);
    }
    return nearest;
  };
  // New vertices at least halve the distance to the edges; none lies on an edge.
  EXPECT_GT(nearestToAnEdge(fine, mesh.vertexCount()), 0);
  EXPECT_LT(nearestToAnEdge(fine, mesh.vertexCount()), 0.51 * nearestToAnEdge(mesh, 0));
}

TEST(SurfaceRefinement, CubeOf12TrianglesIsWithinHalfAPercent) {
  const Matrix6 K = refinedAddedMassOf(makeBoxMesh({1, 1, 1}, 12));
  // 2496 panels; measured 2.4e-3.
  for (int k = 3; k < 6; ++k)
    EXPECT_LT(relativeError(K(k, k), 8 * reference::cubeAddedMassCoefficient()), 3e-3);
}

TEST(SurfaceRefinement, TetrahedronOf4TrianglesIsWithinHalfAPercent) {
  const Matrix6 K = refinedAddedMassOf(test::gradedTetrahedron(1));
  const double exact = reference::tetrahedronAddedMassCoefficient() * 8.0 / 3.0;
  // 2656 panels; measured 1.7e-3.
  for (int k = 3; k < 6; ++k) EXPECT_LT(relativeError(K(k, k), exact), 2.5e-3);
}

TEST(SurfaceRefinement, CoarseSheetIsWithinOnePercent) {
  const Matrix6 K = refinedAddedMassOf(makeRectangularSheetMesh(2, 1, 16), kFinePanels, true);
  // 2216 panels; measured 3.7e-3; its 16 triangles alone: 23 %.
  EXPECT_LT(relativeError(K(5, 5), reference::rectangleAddedMass(2).v_z), 6e-3);
}

TEST(SurfaceRefinement, ReturnsThePotentialAtTheVerticesOfTheMesh) {
  const TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 192);
  PotentialFlowSettings settings;
  settings.max_panels = 1500;
  const PotentialFlow flow = solvePotentialFlow(mesh, settings);
  EXPECT_GT(flow.panels, 500);
  ASSERT_EQ(flow.potential.rows(), mesh.vertexCount());
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v)
    if (mesh.vertices(2, v) == 1) {
      EXPECT_LT(flow.potential(v, 5), -0.1);
    }
}

TEST(SurfaceRefinement, RotationAndSizeStayIdentities) {
  const TriangleMesh skew = test::skewBody(makeBoxMesh({0.5, 0.35, 0.6}, 48));
  // A regular mesh: all choices are equal.
  const TriangleMesh cube = makeBoxMesh({1, 1, 1}, 12);
  const Eigen::Matrix3d R = someRotation();
  for (const TriangleMesh& mesh : {skew, cube}) {
    const Matrix6 K = refinedAddedMassOf(mesh, 600);
    EXPECT_LT(differenceOf(refinedAddedMassOf(rotated(mesh, R), 600), rotateAxes(K, R)), 1e-10);
    EXPECT_LT(differenceOf(refinedAddedMassOf(scaled(mesh, 1e-5), 600), scaleShape(K, 1e-5), 1e-5),
              1e-10);
  }
}

}  // namespace
}  // namespace ambient
