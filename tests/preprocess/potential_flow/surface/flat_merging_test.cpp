#include "preprocess/potential_flow/surface/flat_merging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/potential_flow/surface/shape_symmetry.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"
#include "tests/reference/body_added_mass.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient {
namespace {

using test::differenceOf;
using test::relativeError;
using test::volumeOf;

constexpr int kPanels = 1000;

/// A cube of edge 2; its four sides around y are strips across x of the cube's length.
TriangleMesh cubeOfStrips(int strips) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  const std::vector<Eigen::Vector2d> corners = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int i = 0; i <= strips; ++i)
    for (const Eigen::Vector2d& corner : corners)
      vertices.emplace_back(2.0 * i / strips - 1, corner.x(), corner.y());
  for (int i = 0; i < strips; ++i)
    for (int k = 0; k < 4; ++k) {
      const int a = 4 * i + k, b = 4 * i + (k + 1) % 4;
      triangles.emplace_back(a, b + 4, a + 4);
      triangles.emplace_back(a, b, b + 4);
    }
  const int last = 4 * strips;
  triangles.emplace_back(0, 2, 1);
  triangles.emplace_back(0, 3, 2);
  triangles.emplace_back(last, last + 1, last + 2);
  triangles.emplace_back(last, last + 2, last + 3);
  return meshOf(vertices, triangles);
}

TriangleMesh mergedFrom(const TriangleMesh& mesh) {
  return mergeFlatTriangles(mesh, false, kPanels);
}

double worstAspect(const TriangleMesh& mesh) { return findWorstTriangles(mesh, 1).front().aspect; }

// Least aspect of triangles merged on round bodies: flat_merging.h.
constexpr double kSkinny = 50;

std::set<int> usedVertices(const TriangleMesh& mesh) {
  return {mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size()};
}

// Number of triangles with a vertex above z = 0.
int domeTriangles(const TriangleMesh& mesh) {
  int count = 0;
  for (const auto& corners : mesh.triangles.colwise())
    count += mesh.vertices(2, corners[0]) > 0 || mesh.vertices(2, corners[1]) > 0 ||
             mesh.vertices(2, corners[2]) > 0;
  return count;
}

TEST(FlatMerging, StripsOfACubeBecomeItsTwelveTriangles) {
  const TriangleMesh strips = cubeOfStrips(1000);
  EXPECT_NEAR(worstAspect(strips), 1000, 1);
  const TriangleMesh merged = mergedFrom(strips);
  EXPECT_EQ(merged.triangleCount(), 12);
  EXPECT_NEAR(worstAspect(merged), 2, 1e-9);
  EXPECT_NEAR(volumeOf(merged), 8, 1e-12);
  EXPECT_TRUE(checkMesh(merged, "merged").defects.empty());
  EXPECT_EQ(merged.vertices, strips.vertices);
}

TEST(FlatMerging, RoundingToSinglePrecisionDoesNotMatter) {
  TriangleMesh strips = rotated(cubeOfStrips(200), someRotation());
  strips.vertices = strips.vertices.cast<float>().cast<double>().eval();
  const TriangleMesh merged = mergedFrom(strips);
  EXPECT_EQ(merged.triangleCount(), 12);
  EXPECT_NEAR(volumeOf(merged) / volumeOf(strips), 1, 1e-6);
}

TEST(FlatMerging, KinksStayInPlace) {
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 192);
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    Eigen::Ref<Eigen::Vector3d> p = mesh.vertices.col(v);
    if (p.x() > 1e-9 && p.y() == 1) p.y() = 1 + p.x();  // a prism of five corners
  }
  const TriangleMesh merged = mergedFrom(mesh);
  EXPECT_EQ(merged.triangleCount(), 16);
  EXPECT_NEAR(volumeOf(merged) / volumeOf(mesh), 1, 1e-12);
  EXPECT_TRUE(checkMesh(merged, "merged").defects.empty());
}

TEST(FlatMerging, RoundAndGradedBodiesStayAsTheyAre) {
  for (const TriangleMesh& mesh :
       {makeCylinderMesh(1, 2, 1300), makeConeMesh(1, 1, 1300), makeEllipsoidMesh({3, 2, 1}, 320),
        test::makeTorus({2, 1, 9, 9})})
    EXPECT_EQ(mergedFrom(mesh).triangles, mesh.triangles);
  const TriangleMesh disc = makeEllipticSheetMesh(2, 1, 1200);
  EXPECT_EQ(mergeFlatTriangles(disc, true, 4200).triangles, disc.triangles);
  const TriangleMesh box = makeBoxMesh({1, 1, 1}, 192);
  EXPECT_EQ(mergeFlatTriangles(box, false, 0).triangles, box.triangles) << "no panels to divide";
}

TEST(FlatMerging, SkinnyTrianglesOfARoundBodyGoAndItsRimStays) {
  // Flat face of a hemisphere with two close vertices.
  TriangleMesh mesh = test::gradedHemisphere(6);
  const MeshEdges edges = computeMeshEdges(mesh);
  const auto isInside = [&](int v) {
    return mesh.vertices(2, v) == 0 && mesh.vertices.col(v).norm() < 0.5;
  };
  std::vector<bool> marks;
  for (const EdgeGroup& edge : edges.edges) {
    const HalfEdge& side = edges.half_edges[edge.first];
    const bool first = std::find(marks.begin(), marks.end(), true) == marks.end();
    marks.push_back(first && isInside(side.low) && isInside(side.high));
  }
  TriangleMesh split = cutEdges(undivided(mesh), edges, marks).mesh;
  const auto added = static_cast<int>(mesh.vertexCount());
  ASSERT_EQ(split.vertexCount(), added + 1);
  for (const EdgeGroup& edge : edges.edges) {
    const HalfEdge& side = edges.half_edges[edge.first];
    if (!marks[&edge - edges.edges.data()]) continue;
    split.vertices.col(added) =
        0.999 * mesh.vertices.col(side.low) + 0.001 * mesh.vertices.col(side.high);
  }
  ASSERT_GT(worstAspect(split), kSkinny);
  const TriangleMesh merged = mergedFrom(split);
  EXPECT_LT(worstAspect(merged), kSkinny);
  EXPECT_EQ(merged.triangleCount(), mesh.triangleCount());
  EXPECT_EQ(domeTriangles(merged), domeTriangles(mesh));
  const std::set<int> used = usedVertices(merged);
  EXPECT_EQ(static_cast<int>(used.size()), added) << "one of the two is gone";
  for (int v = 0; v < added; ++v) {
    const bool is_inside_the_flat_face =
        mesh.vertices(2, v) == 0 && mesh.vertices.col(v).norm() < 0.99;
    EXPECT_TRUE(is_inside_the_flat_face || used.count(v)) << v;
  }
  EXPECT_NEAR(volumeOf(merged) / volumeOf(mesh), 1, 1e-12);
}

TEST(FlatMerging, ACubeOfStripsIsAsRightAsThatOfTwelveTriangles) {
  PotentialFlowSettings settings;
  settings.max_panels = kPanels;
  const Matrix6 K = solveRefinedFlow(cubeOfStrips(200), settings).added_mass;
  // Without merging: 100 % in rotation, 14 % in translation. Measured 2e-3, equal to 12 triangles.
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(relativeError(K(k, k), reference::cubeRotationalAddedMass()), 4e-3);
    EXPECT_LT(relativeError(K(k + 3, k + 3), 8 * reference::cubeAddedMassCoefficient()), 3e-3);
  }
}

TEST(FlatMerging, EqualTrianglesLeavePanelsForTheEdges) {
  // 768 equal triangles are 10 % off in rotation.
  PotentialFlowSettings settings;
  settings.max_panels = kPanels;
  const TriangleMesh cube = divideTriangles(makeBoxMesh({1, 1, 1}, 12), 768);
  const Matrix6 K = solveRefinedFlow(cube, settings).added_mass;
  for (int k = 0; k < 3; ++k)
    EXPECT_LT(relativeError(K(k, k), reference::cubeRotationalAddedMass()), 4e-3);
}

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

using Eigen::Vector3d;

std::size_t countOf(const TriangleMesh& mesh, const Vector3d& centre = Vector3d::Zero()) {
  return findSymmetries(mesh, centre).size();
}

TEST(ShapeSymmetry, DiagonalsOfFlatFacesDoNotHideTheMirrorsOfABox) {
  // Three mirrors and three half turns, in both sets of axes.
  const TriangleMesh box = makeBoxMesh({3, 2, 1}, 12);
  EXPECT_EQ(countOf(box), 12U);
  EXPECT_EQ(countOf(moved(box, {1, 2, 3}), {1, 2, 3}), 12U);
  EXPECT_EQ(countOf(rotated(box, someRotation())), 6U) << "by its principal axes alone";
  EXPECT_EQ(countOf(scaled(box, 1e-5)), 12U);
}

TEST(ShapeSymmetry, PlaneTrapezoidsOfATorusMayBeCutAlongAnyDiagonal) {
  EXPECT_GE(countOf(test::makeTorus({2, 1, 8, 8})), 6U);
}

TEST(ShapeSymmetry, TurnsWithoutMirrorsAndMirrorsWithoutTurns) {
  EXPECT_EQ(countOf(test::twisted(makeBoxMesh({1, 0.5, 0.7}, 48), 0.5)), 6U) << "three half turns";
  // Two mirrors and their product, a half turn.
  const TriangleMesh cone = makeConeMesh(1, 1, 64);
  for (const Eigen::Matrix3d& turn : findSymmetries(cone, Vector3d::Zero()))
    EXPECT_NEAR(turn(2, 2), 1, 1e-12);
  EXPECT_GE(countOf(cone), 3U);
}

TEST(ShapeSymmetry, AlmostSymmetricIsNotSymmetric) {
  EXPECT_EQ(countOf(test::skewBody(makeBoxMesh({0.5, 0.35, 0.6}, 48))), 0U);
  TriangleMesh dented = makeBoxMesh({3, 2, 1}, 12);
  dented.vertices(0, 0) += 1e-5;
  EXPECT_EQ(countOf(dented), 0U);
  EXPECT_EQ(countOf(makeBoxMesh({3, 2, 1}, 12), {1e-5, 1e-5, 1e-5}), 0U);
}

TEST(ShapeSymmetry, KeepsExactlyWhatTheMirrorsOfAConeAllow) {
  Matrix6 full;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) full(i, j) = 1 + std::min(i, j) + 7 * std::max(i, j);
  const Matrix6 K = symmetrised(full, {Vector3(-1, 1, 1).asDiagonal().toDenseMatrix(),
                                       Vector3(1, -1, 1).asDiagonal().toDenseMatrix()});
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      // x -> -x changes the sign of rotations about y, z and of translations along x.
      const bool coupled =
          (i == 0 && j == 4) || (i == 4 && j == 0) || (i == 1 && j == 3) || (i == 3 && j == 1);
      EXPECT_EQ(K(i, j), i == j || coupled ? full(i, j) : 0) << i << " " << j;
    }
}

}  // namespace
}  // namespace ambient
