#include "preprocess/mesh/triangle_quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

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
