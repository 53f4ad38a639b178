#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

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

}  // namespace
}  // namespace ambient
