#include "preprocess/mesh/weld_vertices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

TEST(WeldVertices, JoinsWhatIsCloserThanTheToleranceAndNothingElse) {
  const double tolerance = 1e-3;
  const TriangleMesh soup = meshOf(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0.9e-3}, {1, 1, 0}, {0, 1.0005, 0}, {0, 1, 1.1e-3}},
      {{0, 1, 2}, {3, 4, 5}, {6, 0, 1}, {2, 5, 4}});
  const TriangleMesh welded = weldVertices(soup, tolerance);
  ASSERT_EQ(welded.vertexCount(), 5);
  EXPECT_EQ(welded.vertices.col(1), soup.vertices.col(1));
  ASSERT_EQ(welded.triangleCount(), 3) << "the last triangle has lost a corner";
  EXPECT_EQ(welded.triangles.col(1), Eigen::Vector3i(1, 3, 2));
  EXPECT_EQ(welded.triangles.col(2), Eigen::Vector3i(4, 0, 1));
}

TEST(WeldVertices, FindsNeighboursAcrossCells) {
  // 1000 vertices, each with a copy at 0.9 of the tolerance in a random direction.
  std::vector<Eigen::Vector3d> vertices;
  for (int i = 0; i < 1000; ++i) {
    const int row = i / 10, layer = i / 100;
    const Eigen::Vector3d p(0.1 * (i % 10), 0.1 * (row % 10), 0.1 * layer);
    const Eigen::Vector3d direction(std::sin(i), std::sin(2 * i + 1), std::cos(3 * i));
    vertices.push_back(p);
    vertices.push_back(p + 0.9e-4 * direction.normalized());
  }
  EXPECT_EQ(weldVertices(meshOf(vertices, {}), 1e-4).vertexCount(), 1000);
  EXPECT_EQ(weldVertices(meshOf(vertices, {}), 0.8e-4).vertexCount(), 2000);
}

}  // namespace
}  // namespace ambient
