#include "preprocess/mesh/convex_hull.h"

#include <gtest/gtest.h>

#include <random>

#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/primitives.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

TriangleMesh hullOf(const Eigen::Matrix3Xd& points) {
  const TriangleMesh hull = makeConvexHull(points, "thing.obj");
  EXPECT_TRUE(isClosed(computeMeshEdges(hull)));
  return hull;
}

/// How far the points reach out of the hull.
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

// All points on the sides of a box: most are in the planes of its facets, and in line with its
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
    if (cloud % 2 == 0) points = points.array().round();  // many in the same planes and places
    EXPECT_LT(mostOutside(hullOf(points), points), 1e-7) << cloud;
  }
}

TEST(ConvexHull, PointsOnABallAreAllCorners) {
  const TriangleMesh ball = makeEllipsoidMesh({1, 1, 1}, 1280);
  const TriangleMesh hull = hullOf(ball.vertices);
  EXPECT_EQ(hull.vertexCount(), ball.vertexCount());
  EXPECT_EQ(hull.triangleCount(), ball.triangleCount());
}

TEST(ConvexHull, PointsWithoutVolumeAreRefused) {
  const auto refusal = [](const Eigen::Matrix3Xd& points) {
    return messageOf([&] { makeConvexHull(points, "thing.obj"); });
  };
  const std::string flat = "thing.obj: its points span no volume: they have no hull";
  EXPECT_EQ(refusal(Eigen::Matrix3Xd(3, 0)), flat);
  EXPECT_EQ(refusal(Eigen::Matrix3Xd::Ones(3, 5)), flat);
  EXPECT_EQ(refusal(makeRectangularSheetMesh(1, 1, 200).vertices), flat);
  Eigen::Matrix3Xd broken = makeBoxMesh({1, 1, 1}, 12).vertices;
  broken(1, 3) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(broken), "thing.obj: a point of the hull is not finite");
}

}  // namespace
}  // namespace ambient
