#include "preprocess/mesh/shapes/convex_hull.h"

#include <gtest/gtest.h>

#include <random>

#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

TriangleMesh hullOf(const Eigen::Matrix3Xd& points) {
  const TriangleMesh hull = makeConvexHull(points, "thing.obj");
  EXPECT_TRUE(isClosed(computeMeshEdges(hull)));
  return hull;
}

/// Largest distance of a point outside of the hull.
double mostOutside(const TriangleMesh& hull, const Eigen::Matrix3Xd& points) {
  double most = 0;
  for (Eigen::Index t = 0; t < hull.triangleCount(); ++t) {
    const Eigen::Vector3d a = hull.corner(t, 0);
    const Eigen::Vector3d normal =
        (hull.corner(t, 1) - a).cross(hull.corner(t, 2) - a).normalized();
    most = std::max(most, (normal.transpose() * (points.colwise() - a)).maxCoeff());
  }
  return most;
}

// Points on a grid over the sides of a box: most lie in planes of facets and on lines of
// edges.
TEST(ConvexHull, GridsOfPointsInPlanesHaveTheHullOfTheBox) {
  for (const int faces : {12, 300, 3000}) {
    const TriangleMesh box = makeBoxMesh({1, 2, 3}, faces);
    const TriangleMesh hull = hullOf(box.vertices);
    EXPECT_NEAR(computeMassProperties(hull).volume, 48, 1e-6) << faces;
    EXPECT_LT(mostOutside(hull, box.vertices), 1e-8);
  }
}

TEST(ConvexHull, NoPointOfACloudLiesOutside) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int cloud = 0; cloud < 20; ++cloud) {
    Eigen::Matrix3Xd points(3, 500);
    for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = normal(random);
    if (cloud % 2 == 0) points = points.array().round();  // many points coplanar or coincident
    EXPECT_LT(mostOutside(hullOf(points), points), 1e-7) << cloud;
  }
}

TEST(ConvexHull, PointsOnABallAreAllCorners) {
  const TriangleMesh ball = makeEllipsoidMesh({1, 1, 1}, 1280);
  const TriangleMesh hull = hullOf(ball.vertices);
  EXPECT_EQ(hull.vertexCount(), ball.vertexCount());
  EXPECT_EQ(hull.triangleCount(), ball.triangleCount());
}

// Points of a float: on the fine lattice, needles end at points that are off an edge by rounding.
TEST(ConvexHull, OnTheCoarseLatticePointsOffASideByRoundingAreNoCorners) {
  Eigen::Matrix3Xd points = makeBoxMesh({1, 2, 3}, 300).vertices;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1e-7, 1e-7);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] += noise(random);
  EXPECT_GT(hullOf(points).vertexCount(), 20);
  const TriangleMesh hull = makeConvexHull(points, "box", kCoarseHullBits);
  EXPECT_EQ(hull.vertexCount(), 8);
  EXPECT_EQ(hull.triangleCount(), 12);
  EXPECT_NEAR(computeMassProperties(hull).volume, 48, 1e-5);
}

TEST(ConvexHull, PointsWithoutVolumeAreRefused) {
  const auto refusal = [](const Eigen::Matrix3Xd& points) {
    return messageOf([&] { makeConvexHull(points, "thing.obj"); });
  };
  const std::string flat = "thing.obj: the points of the hull lie in a plane";
  EXPECT_EQ(refusal(Eigen::Matrix3Xd(3, 0)),
            "thing.obj: a convex hull of 0 points needs at least 4");
  EXPECT_EQ(refusal(Eigen::Matrix3Xd::Ones(3, 5)), flat);
  EXPECT_EQ(refusal(makeRectangularSheetMesh(1, 1, 200).vertices), flat);
  Eigen::Matrix3Xd broken = makeBoxMesh({1, 1, 1}, 12).vertices;
  broken(1, 3) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(broken), "thing.obj: a point of the hull is not finite");
}

}  // namespace
}  // namespace ambient
