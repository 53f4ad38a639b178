#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/collision_shape/solids.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mend/mesh_mending.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/union/bsp_tree.h"
#include "preprocess/mesh/union/mesh_union.h"
#include "preprocess/mesh/wrap/grid_surface.h"
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

TEST(BspTree, TakesOffWhatIsInside) {
  const BspTree cube(makeBoxMesh({1, 1, 1}, 200), 1e-9);
  EXPECT_NEAR(areaOf(cube.clip(squareAt(0, 2, true), true)), 16 - 4, 1e-12);
  EXPECT_EQ(areaOf(cube.clip(squareAt(0, 0.5, true), true)), 0);
  EXPECT_EQ(cube.clip(squareAt(1.1, 2, true), true).size(), 1u) << "not cut where not needed";
}

// Other planes of the solid meet the polygon, too, but leave no edge of the hole.
TEST(BspTree, ConvexCutsOncePerEdgeOfTheHole) {
  const TriangleMesh ball = makeEllipsoidMesh({1, 1, 1}, 320);
  constexpr double kHeight = 0.3;
  std::size_t edges = 0;
  for (Eigen::Index t = 0; t < ball.triangleCount(); ++t) {
    double low = 1, high = -1;
    for (int k = 0; k < 3; ++k) {
      low = std::min(low, ball.corner(t, k).z());
      high = std::max(high, ball.corner(t, k).z());
    }
    if (low < kHeight && kHeight < high) ++edges;
  }
  const auto pieces = BspTree(ball, 1e-9).clip(squareAt(kHeight, 2, true), true);
  EXPECT_LE(pieces.size(), edges);
  EXPECT_NEAR(areaOf(pieces), 16 - kPi * (1 - kHeight * kHeight), 0.1);  // of chords
}

TEST(BspTree, DecidesOnItsSurfaceByTheNormal) {
  const BspTree cube(makeBoxMesh({1, 1, 1}, 200), 1e-9);
  // The solid above touches; the one below is flush, and one of the two keeps the common face.
  for (const bool keep : {false, true}) {
    EXPECT_NEAR(areaOf(cube.clip(squareAt(1, 2, false), keep)), 12, 1e-12);
    EXPECT_NEAR(areaOf(cube.clip(squareAt(1, 2, true), keep)), keep ? 16 : 12, 1e-12);
    EXPECT_NEAR(areaOf(cube.clip(squareAt(-1, 2, true), keep)), 12, 1e-12);
    EXPECT_NEAR(areaOf(cube.clip(squareAt(-1, 2, false), keep)), keep ? 16 : 12, 1e-12);
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

constexpr int kFaces = 350;

TEST(SolidUnion, UnitesBoxesThatLieNearlyFlush) {
  const SeparateSolids separate = uniteSolids(nearlyFlushPair(), kFaces, "it");
  ASSERT_EQ(separate.solids.size(), 1u);
  EXPECT_TRUE(separate.are_joined);
  EXPECT_NEAR(computeMassProperties(separate.solids[0].mesh).volume / 1.5, 1, 5e-3);
}

// Rounded hulls that lie in each other, as a convex decomposition of a toy has them. Every other
// corner lies beside another one, so that some edges are as short as what is welded.
std::vector<Solid> roundedHulls(unsigned seed) {
  constexpr int kHulls = 16, kCorners = 120;
  std::mt19937 generator(seed);
  const auto random = [&] {
    return 2 * static_cast<double>(generator()) / std::mt19937::max() - 1;
  };
  const auto randomVector = [&] {
    const double x = random(), y = random(), z = random();
    return Eigen::Vector3d(x, y, z);
  };
  std::vector<Solid> solids;
  for (int i = 0; i < kHulls; ++i) {
    const Eigen::Vector3d centre = 0.6 * randomVector();
    const Eigen::Vector3d axes = Eigen::Vector3d::Constant(0.5) + 0.2 * randomVector();
    Eigen::Matrix3Xd corners(3, kCorners);
    for (int k = 0; k < kCorners; k += 2) {
      corners.col(k) = centre + axes.cwiseProduct(randomVector().normalized());
      corners.col(k + 1) = corners.col(k) + 1e-4 * randomVector();
    }
    Solid solid;
    solid.mesh = makeConvexHull(corners, "hull");
    solid.name = "child " + std::to_string(i);
    solids.push_back(solid);
  }
  return solids;
}

bool canBeUnitedAtOnce(const std::vector<TriangleMesh>& meshes) {
  try {
    uniteMeshes(meshes, "it", UnionTries::kOne);
    return true;
  } catch (const std::runtime_error&) {
    return false;
  }
}

TEST(SolidUnion, WrapsRoundPartsThatCannotBeUnited) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const std::vector<Solid> solids = roundedHulls(seed);
    std::vector<TriangleMesh> meshes;
    for (const Solid& solid : solids) meshes.push_back(solid.mesh);
    if (canBeUnitedAtOnce(meshes)) continue;
    const double volume = volumeOfUnion(meshes);
    EXPECT_LT(volume, 0.9 * sumOfVolumes(meshes));
    const SeparateSolids separate = uniteSolids(solids, kFaces, "it");
    ASSERT_EQ(separate.solids.size(), 1u);
    EXPECT_TRUE(separate.are_joined);
    EXPECT_TRUE(isClosed(computeMeshEdges(separate.solids[0].mesh)));
    EXPECT_NEAR(computeMassProperties(separate.solids[0].mesh).volume, volume, 1e-6 * volume);
    return;
  }
  FAIL() << "all were united at once";
}

TEST(SolidUnion, VolumesAreThoseOfTheUnion) {
  const TriangleMesh cube = makeBoxMesh({0.5, 0.5, 0.5}, 48);
  EXPECT_NEAR(volumeOfUnion({cube, moved(cube, {7, 0.25, 0})}), 2, 2e-4);
  EXPECT_NEAR(volumeOfUnion({cube, moved(cube, {0.5, 0.25, 0})}), 2 - 0.5 * 0.75, 2e-4);
}

// Convex pieces of a ball as programs for convex decompositions make them: the hulls of the cubes
// of a grid that lie nearest to one of several places.
std::vector<TriangleMesh> decomposedBall(int pieces) {
  constexpr int kCubes = 12;  // from the centre to the surface
  std::mt19937 generator;
  Eigen::Matrix3Xd places(3, pieces);
  for (double& x : places.reshaped())
    x = 1.6 * static_cast<double>(generator()) / std::mt19937::max() - 0.8;
  std::vector<std::vector<Eigen::Vector3d>> corners(static_cast<std::size_t>(pieces));
  for (int i = 0; i < 8 * kCubes * kCubes * kCubes; ++i) {
    const Eigen::Vector3i cube(i % (2 * kCubes), i / (2 * kCubes) % (2 * kCubes),
                               i / (4 * kCubes * kCubes));
    const Eigen::Vector3d middle = (cube.cast<double>().array() + 0.5) / kCubes - 1;
    if (middle.norm() > 1) continue;
    Eigen::Index nearest = 0;
    (places.colwise() - middle).colwise().squaredNorm().minCoeff(&nearest);
    for (int k = 0; k < 8; ++k)
      corners[nearest].push_back(middle +
                                 Eigen::Vector3d(k & 1, k & 2, k & 4).cwiseSign() / kCubes -
                                 Eigen::Vector3d::Constant(0.5 / kCubes));
  }
  std::vector<TriangleMesh> hulls;
  for (const auto& piece : corners) {
    Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(piece.size()));
    for (std::size_t i = 0; i < piece.size(); ++i)
      points.col(static_cast<Eigen::Index>(i)) = piece[i];
    hulls.push_back(makeConvexHull(points.cast<float>().cast<double>(), "piece"));
  }
  return hulls;
}

bool isInside(const TriangleMesh& hull, const Eigen::Vector3d& x) {
  for (Eigen::Index t = 0; t < hull.triangleCount(); ++t)
    if (hull.twiceArea(t).dot(x - hull.corner(t, 0)) > 0) return false;
  return true;
}

// Share of evenly spread points that are in a piece.
TEST(SolidUnion, VolumeOfAConvexDecompositionIsWhatCountingPointsGives) {
  constexpr int kPoints = 200000;
  const std::vector<TriangleMesh> hulls = decomposedBall(14);
  const Eigen::Vector3d spread(0.8191725133961645, 0.6710436067037893, 0.5497004779019702);
  int inside = 0;
  for (int i = 0; i < kPoints; ++i) {
    Eigen::Vector3d x = i * spread;
    x = 2 * (x.array() - x.array().floor()) - 1;
    inside += std::any_of(hulls.begin(), hulls.end(),
                          [&](const TriangleMesh& hull) { return isInside(hull, x); });
  }
  EXPECT_NEAR(volumeOfUnion(hulls) / (8.0 * inside / kPoints), 1, 1e-3);
}

TEST(SolidUnion, IsAWrapWhereNoFlowGoesAroundIt) {
  const std::vector<Solid> solids = roundedHulls(1);
  const SeparateSolids wrap = uniteSolids(solids, kFaces, "it", JoinedBy::kWrap, "no flow");
  ASSERT_EQ(wrap.solids.size(), 1u);
  EXPECT_TRUE(wrap.are_joined);
  EXPECT_TRUE(wrap.solids[0].warnings.empty());
  std::vector<TriangleMesh> meshes;
  for (const Solid& solid : solids) meshes.push_back(solid.mesh);
  const double volume = volumeOfUnion(meshes);
  EXPECT_NEAR(computeMassProperties(wrap.solids[0].mesh).volume, volume, 1e-6 * volume);
}

TEST(SolidUnion, LeavesSolidsWithGapsAlone) {
  const SeparateSolids separate =
      uniteSolids({cubeSolid(0, "a"), cubeSolid(2, "b"), cubeSolid(2.5, "c")}, kFaces, "it");
  ASSERT_EQ(separate.solids.size(), 2u);
  EXPECT_TRUE(separate.are_joined);
  EXPECT_NEAR(computeMassProperties(separate.solids[0].mesh).volume, 1, 1e-12);
  EXPECT_NEAR(computeMassProperties(separate.solids[1].mesh).volume, 1.5, 1e-12);
}

TEST(SolidUnion, FallsBackToTheHullWithItsCost) {
  const SeparateSolids separate = uniteSolids(platesAlongANarrowGap(), kFaces, "it");
  ASSERT_EQ(separate.solids.size(), 1u);
  EXPECT_NEAR(computeMassProperties(separate.solids[0].mesh).volume, 0.0405, 1e-6);
  ASSERT_EQ(separate.solids[0].warnings.size(), 1u);
  const std::string& warning = separate.solids[0].warnings[0];
  EXPECT_EQ(warning.rfind("it: child 0 (Box) and child 1 (Box) cannot be united (", 0), 0u);
  EXPECT_NE(warning.find("(a gap between them is too narrow"), std::string::npos) << warning;
  EXPECT_NE(warning.find("their convex hull stands for them, with 1.25 % more"), std::string::npos)
      << warning;
}

// Hulls that barely overlap: some points differ by little more than rounding.
TEST(SolidUnion, HullsOfPointsSideBySideHaveNoFlatTriangles) {
  std::vector<Solid> solids{cubeSolid(0, "a"), cubeSolid(0, "b")};
  for (Eigen::Index v = 0; v < solids[1].mesh.vertexCount(); ++v)
    solids[1].mesh.vertices.col(v) +=
        1e-8 * std::sin(7.0 * static_cast<double>(v)) * Eigen::Vector3d(1, 2, 3);
  const SeparateSolids separate = uniteSolids(solids, kFaces, "it", JoinedBy::kHull, "no flow");
  ASSERT_EQ(separate.solids.size(), 1u);
  const TriangleMesh& hull = separate.solids[0].mesh;
  EXPECT_TRUE(isClosed(computeMeshEdges(hull)));
  EXPECT_TRUE(findFlatTriangles(hull).empty());
  EXPECT_NEAR(computeMassProperties(hull).volume, 1, 1e-6);
  PotentialFlowSettings flow;
  flow.sheet = false;
  EXPECT_NO_THROW(solvePotentialFlow(hull, flow));
}

// Replaces a union after its flow has failed.
TEST(SolidUnion, IsReplacedByWhatStandsForIt) {
  const std::vector<Solid> solids{cubeSolid(0, "a"), cubeSolid(0.5, "b"), cubeSolid(3, "c")};
  EXPECT_TRUE(uniteSolids(solids, kFaces, "it").are_joined);
  const SeparateSolids hull = uniteSolids(solids, kFaces, "it", JoinedBy::kHull, "no flow");
  ASSERT_EQ(hull.solids.size(), 2u);
  EXPECT_FALSE(hull.are_joined);
  EXPECT_NEAR(computeMassProperties(hull.solids[0].mesh).volume, 1.5, 1e-12);
  EXPECT_EQ(hull.solids[0].warnings.at(0).rfind("it: a and b cannot be united (no flow): ", 0), 0u);
  EXPECT_TRUE(hull.solids[1].warnings.empty());
}

}  // namespace
}  // namespace ambient
