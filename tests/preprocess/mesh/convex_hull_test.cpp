#include "preprocess/mesh/shapes/convex_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wrap/mesh_coarsening.h"
#include "preprocess/mesh/wrap/surface_wrap.h"
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

using Polygon = std::vector<Eigen::Vector3d>;

Eigen::Vector3d areaVector(const Polygon& polygon) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sum += polygon[i].cross(polygon[(i + 1) % polygon.size()]) / 2;
  }
  return sum;
}

// Compares the signed area of the triangles with the polygon's. Equality means cover without
// overlap: a triangle of the other orientation counts negative.
void expectCovered(const Polygon& polygon, const std::string& what) {
  const auto triangles = dividePolygon(polygon);
  ASSERT_EQ(triangles.size(), polygon.size() - 2) << what;
  const Eigen::Vector3d area = areaVector(polygon);
  double sum = 0;
  for (const Eigen::Vector3i& t : triangles) {
    const Eigen::Vector3d part = areaVector({polygon[t[0]], polygon[t[1]], polygon[t[2]]});
    EXPECT_GT(part.dot(area), 0) << what;
    sum += part.norm();
  }
  EXPECT_NEAR(sum / area.norm(), 1, 1e-13) << what;
}

Polygon inSpace(Polygon polygon) {
  for (Eigen::Vector3d& corner : polygon) {
    corner = someRotation() * corner + Eigen::Vector3d(3, -2, 5);
  }
  return polygon;
}

TEST(PolygonTriangles, CoverConcavePolygons) {
  const Polygon l{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  for (std::size_t first = 0; first < l.size(); ++first) {
    Polygon turned = l;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(first), turned.end());
    expectCovered(inSpace(turned), "L from corner " + std::to_string(first));
    std::reverse(turned.begin(), turned.end());
    expectCovered(inSpace(turned), "reversed L from corner " + std::to_string(first));
  }
}

TEST(PolygonTriangles, CoverPolygonsWithCornersOnStraightSides) {
  const Polygon square{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                       {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  expectCovered(square, "square");
  expectCovered(inSpace(square), "square in space");
}

TEST(PolygonTriangles, CoverRandomStars) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(0.2, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 4 + trial % 20;
    Polygon star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979323846 * i / n, r = radius(random);
      star.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    }
    expectCovered(inSpace(star), "star " + std::to_string(trial));
  }
}

TEST(PolygonTriangles, SplitQuadsAlongTheBetterDiagonal) {
  const Polygon kite{{-1, 0, 0}, {0, -0.1, 0}, {1, 0, 0}, {0, 0.1, 0}};
  for (const Eigen::Vector3i& t : dividePolygon(kite)) {
    EXPECT_TRUE((t.array() == 1).any() && (t.array() == 3).any()) << "the short diagonal is shared";
  }
}

TEST(ThinnestPart, OfABoxIsItsThickness) {
  const auto box = findThinnestPart(makeBoxMesh({1, 2, 0.05}, 200));
  ASSERT_TRUE(box);
  EXPECT_NEAR(box->thickness, 0.1, 1e-12);
  EXPECT_NEAR(std::abs(box->barycentre.z()), 0.05, 1e-12);
  const auto two = findThinnestPart(
      joined(makeBoxMesh({1, 1, 1}, 12), moved(makeBoxMesh({1, 1, 0.25}, 12), {0, 0, 1.3})));
  EXPECT_NEAR(two->thickness, 0.5, 1e-12) << "the gap of 0.05 is not a part";
}

TEST(WorstTriangles, AreSortedByAspect) {
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 12);
  mesh.vertices.row(2) *= 0.001;
  const auto worst = findWorstTriangles(mesh, 100);
  ASSERT_EQ(worst.size(), 12u);
  EXPECT_NEAR(worst.front().aspect, 1000, 1);
  EXPECT_NEAR(worst.front().smallest_angle, 0.001, 1e-6);
  EXPECT_NEAR(worst.back().aspect, 2, 1e-12);
  EXPECT_NEAR(worst.back().smallest_angle, std::acos(-1.0) / 4, 1e-12);
  EXPECT_EQ(findWorstTriangles(mesh, 3).size(), 3u);
}

/// A unit ball by meridians and parallels. Triangles at the poles are slivers, `meridians` / 2 pi
/// times as long as wide.
TriangleMesh ballOfMeridians(int meridians, int parallels) {
  const int south = 1 + (parallels - 1) * meridians;
  const auto vertex = [&](int parallel, int meridian) {
    return 1 + (parallel - 1) * meridians + meridian % meridians;
  };
  TriangleMesh mesh;
  mesh.vertices.resize(3, south + 1);
  mesh.triangles.resize(3, 2 * meridians * (parallels - 1));
  mesh.vertices.col(0) = Eigen::Vector3d::UnitZ();
  mesh.vertices.col(south) = -Eigen::Vector3d::UnitZ();
  Eigen::Index t = 0;
  for (int j = 0; j < meridians; ++j) {
    for (int i = 1; i < parallels; ++i) {
      const double polar = kPi * i / parallels, azimuth = 2 * kPi * j / meridians;
      mesh.vertices.col(vertex(i, j)) << std::sin(polar) * std::cos(azimuth),
          std::sin(polar) * std::sin(azimuth), std::cos(polar);
      if (i + 1 == parallels) break;
      mesh.triangles.col(t++) << vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1);
      mesh.triangles.col(t++) << vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1);
    }
    mesh.triangles.col(t++) << 0, vertex(1, j), vertex(1, j + 1);
    mesh.triangles.col(t++) << vertex(parallels - 1, j), south, vertex(parallels - 1, j + 1);
  }
  return mesh;
}

// Without contraction of slivers 4734 triangles with 27 % more area would remain.
TEST(MeshCoarsening, ContractsTheSliversAroundPoles) {
  const TriangleMesh mesh = ballOfMeridians(360, 60);
  const auto fewer = inFewerTriangles(mesh, 1500);
  ASSERT_TRUE(fewer);
  EXPECT_LE(fewer->triangleCount(), 1500);
  const MeshProperties found = computeMassProperties(*fewer), body = computeMassProperties(mesh);
  EXPECT_NEAR(found.area / body.area, 1, 0.005);
  EXPECT_NEAR(found.volume / body.volume, 1, 1e-12);
  EXPECT_LT(fewer->vertices.colwise().norm().maxCoeff(), 1.01);
}

TEST(MeshCoarsening, OfABodyThatSoFewDoNotShowGivesNone) {
  EXPECT_FALSE(inFewerTriangles(makeEllipsoidMesh({1, 1, 1}, 1280), 20));
}

}  // namespace
}  // namespace ambient
