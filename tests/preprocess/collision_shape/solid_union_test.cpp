#include "preprocess/collision_shape/solids/solid_union.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mend/crack_mending.h"
#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/union/solid_tree.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

FlatPolygon squareAt(double height, double half, bool upwards) {
  FlatPolygon square;
  square.corners = {
      {-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height}};
  square.normal = {0, 0, 1};
  if (upwards) return square;
  std::swap(square.corners[1], square.corners[3]);
  square.normal = {0, 0, -1};
  return square;
}

double areaOf(const std::vector<FlatPolygon>& polygons) {
  Eigen::Vector3d twice = Eigen::Vector3d::Zero();
  for (const FlatPolygon& polygon : polygons) {
    for (std::size_t i = 2; i < polygon.corners.size(); ++i) {
      twice += (polygon.corners[i - 1] - polygon.corners[0])
                   .cross(polygon.corners[i] - polygon.corners[0]);
    }
  }
  return twice.norm() / 2;
}

TEST(SolidTree, TakesOffWhatIsInside) {
  const SolidTree cube(makeBoxMesh({1, 1, 1}, 200), 1e-9);
  EXPECT_NEAR(areaOf(cube.cutOff(squareAt(0, 2, true), true)), 16 - 4, 1e-12);
  EXPECT_EQ(areaOf(cube.cutOff(squareAt(0, 0.5, true), true)), 0);
  EXPECT_EQ(cube.cutOff(squareAt(1.1, 2, true), true).size(), 1u) << "not cut where not needed";
}

TEST(SolidTree, DecidesOnItsSurfaceByTheNormal) {
  const SolidTree cube(makeBoxMesh({1, 1, 1}, 200), 1e-9);
  // The solid above touches; the one below is flush, and one of the two keeps the common face.
  for (const bool keep : {false, true}) {
    EXPECT_NEAR(areaOf(cube.cutOff(squareAt(1, 2, false), keep)), 12, 1e-12);
    EXPECT_NEAR(areaOf(cube.cutOff(squareAt(1, 2, true), keep)), keep ? 16 : 12, 1e-12);
    EXPECT_NEAR(areaOf(cube.cutOff(squareAt(-1, 2, true), keep)), 12, 1e-12);
    EXPECT_NEAR(areaOf(cube.cutOff(squareAt(-1, 2, false), keep)), keep ? 16 : 12, 1e-12);
  }
}

TEST(Cracks, AreClosedWhereAVertexLiesOnAnEdge) {
  // A tetrahedron with one triangle cut in two at the middle of an edge.
  const TriangleMesh mesh = meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 1e-9, 0}},
                                   {{0, 2, 4}, {4, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  EXPECT_FALSE(isClosed(computeMeshEdges(mesh)));
  EXPECT_TRUE(isClosed(computeMeshEdges(withoutCracks(mesh, 1e-7))));
  EXPECT_FALSE(isClosed(computeMeshEdges(withoutCracks(mesh, 1e-10))));
}

Solid cubeSolid(double x, const char* part) {
  Solid solid;
  solid.mesh = moved(makeBoxMesh({0.5, 0.5, 0.5}, 48), {x, 0, 0});
  solid.name = part;
  return solid;
}

// Two cubes that overlap by half. A tiny turn of one makes their sides cross in
// slivers.
std::vector<Solid> nearlyFlushPair() {
  std::vector<Solid> solids{cubeSolid(0, "child 0 (Box)"), cubeSolid(0, "child 1 (Box)")};
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 3).normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(3e-4, axis).toRotationMatrix();
  const Eigen::Matrix3Xd turned = turn * solids[1].mesh.vertices;
  solids[1].mesh.vertices = turned.colwise() + Eigen::Vector3d(0.5, 0, 0);
  return solids;
}

// A gap of half a thousandth of the plates' size, too wide for the enlargement to close.
std::vector<Solid> platesAlongANarrowGap() {
  std::vector<Solid> solids{cubeSolid(0, "child 0 (Box)"), cubeSolid(0, "child 1 (Box)")};
  for (Solid& solid : solids) solid.mesh.vertices.row(2) *= 0.02;
  solids[1].mesh.vertices.row(2).array() += 0.0205;
  return solids;
}

UnionSettings fallingBackTo(CompoundFallback fallback) { return {350, fallback}; }

TEST(SolidUnion, UnitesBoxesThatLieNearlyFlush) {
  const SeparateSolids separate =
      uniteSolids(nearlyFlushPair(), fallingBackTo(CompoundFallback::kRefuse), "it");
  ASSERT_EQ(separate.solids.size(), 1u);
  EXPECT_TRUE(separate.has_unions);
  EXPECT_NEAR(computeMassProperties(separate.solids[0].mesh).volume / 1.5, 1, 5e-3);
}

TEST(SolidUnion, LeavesSolidsWithGapsAlone) {
  const SeparateSolids separate =
      uniteSolids({cubeSolid(0, "a"), cubeSolid(2, "b"), cubeSolid(2.5, "c")},
                  fallingBackTo(CompoundFallback::kHull), "it");
  ASSERT_EQ(separate.solids.size(), 2u);
  EXPECT_FALSE(separate.is_sum);
  EXPECT_NEAR(computeMassProperties(separate.solids[0].mesh).volume, 1, 1e-12);
  EXPECT_NEAR(computeMassProperties(separate.solids[1].mesh).volume, 1.5, 1e-12);
}

TEST(SolidUnion, FallsBackToTheHullWithItsCost) {
  const SeparateSolids separate =
      uniteSolids(platesAlongANarrowGap(), fallingBackTo(CompoundFallback::kHull), "it");
  ASSERT_EQ(separate.solids.size(), 1u);
  EXPECT_NEAR(computeMassProperties(separate.solids[0].mesh).volume, 0.0405, 1e-6);
  ASSERT_EQ(separate.solids[0].warnings.size(), 1u);
  const std::string& warning = separate.solids[0].warnings[0];
  EXPECT_EQ(warning.rfind("it: child 0 (Box) and child 1 (Box) cannot be united (", 0), 0u);
  EXPECT_NE(warning.find("their convex hull stands for them, with 1.25 % more"), std::string::npos)
      << warning;
}

// Hulls that barely overlap: some points differ by little more than rounding.
TEST(SolidUnion, HullsOfPointsSideBySideHaveNoFlatTriangles) {
  std::vector<Solid> solids{cubeSolid(0, "a"), cubeSolid(0, "b")};
  for (Eigen::Index v = 0; v < solids[1].mesh.vertexCount(); ++v)
    solids[1].mesh.vertices.col(v) +=
        1e-8 * std::sin(7.0 * static_cast<double>(v)) * Eigen::Vector3d(1, 2, 3);
  const SeparateSolids separate =
      replaceUnions(solids, fallingBackTo(CompoundFallback::kHull), "no flow", "it");
  ASSERT_EQ(separate.solids.size(), 1u);
  const TriangleMesh& hull = separate.solids[0].mesh;
  EXPECT_TRUE(isClosed(computeMeshEdges(hull)));
  EXPECT_TRUE(findFlatTriangles(hull).empty());
  EXPECT_NEAR(computeMassProperties(hull).volume, 1, 1e-6);
  PotentialFlowSettings flow;
  flow.sheet = false;
  EXPECT_NO_THROW(solvePotentialFlow(hull, flow));
}

TEST(SolidUnion, FallsBackToTheSum) {
  const SeparateSolids separate =
      uniteSolids(platesAlongANarrowGap(), fallingBackTo(CompoundFallback::kSum), "it");
  EXPECT_EQ(separate.solids.size(), 2u);
  EXPECT_TRUE(separate.is_sum);
  ASSERT_EQ(separate.solids[0].warnings.size(), 1u);
}

TEST(SolidUnion, RefusesIfToldTo) {
  const std::string message = messageOf(
      [] { uniteSolids(platesAlongANarrowGap(), fallingBackTo(CompoundFallback::kRefuse), "it"); });
  EXPECT_EQ(message.rfind("it: child 0 (Box) and child 1 (Box) touch or overlap and cannot be "
                          "united (a gap between them is too narrow",
                          0),
            0u)
      << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

// Replaces a union after its flow has failed.
TEST(SolidUnion, IsReplacedByWhatStandsForIt) {
  const std::vector<Solid> solids{cubeSolid(0, "a"), cubeSolid(0.5, "b"), cubeSolid(3, "c")};
  EXPECT_TRUE(uniteSolids(solids, fallingBackTo(CompoundFallback::kHull), "it").has_unions);
  const SeparateSolids hull =
      replaceUnions(solids, fallingBackTo(CompoundFallback::kHull), "no flow", "it");
  ASSERT_EQ(hull.solids.size(), 2u);
  EXPECT_FALSE(hull.has_unions);
  EXPECT_NEAR(computeMassProperties(hull.solids[0].mesh).volume, 1.5, 1e-12);
  EXPECT_EQ(hull.solids[0].warnings.at(0).rfind("it: a and b cannot be united (no flow): ", 0), 0u);
  EXPECT_TRUE(hull.solids[1].warnings.empty());
  const SeparateSolids sum =
      replaceUnions(solids, fallingBackTo(CompoundFallback::kSum), "no flow", "it");
  EXPECT_EQ(sum.solids.size(), 3u);
  EXPECT_TRUE(sum.is_sum);
}

}  // namespace
}  // namespace ambient
