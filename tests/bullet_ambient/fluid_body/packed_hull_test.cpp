#include "bullet_ambient/fluid_body/packed_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/hull_bodies.h"
#include "tests/support/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;

TEST(PackedHull, KnowsItsExtentInEveryDirection) {
  Arbitrary arbitrary(1);
  test::Triangulation mesh = test::geodesicSphere(3);
  for (Vector3& v : mesh.vertices) v = arbitrary.between(0.5, 2) * v + Vector3(1, 2, 3);
  const PackedHull hull(test::hullBody(mesh));
  for (int i = 0; i < 100; ++i) {
    const Vector3 s = arbitrary.vector().normalized();
    double low = 1e9, high = -1e9;
    for (const Vector3& v : mesh.vertices) {
      low = std::min(low, s.dot(v));
      high = std::max(high, s.dot(v));
    }
    EXPECT_EQ(hull.extent(s).first, low);
    EXPECT_EQ(hull.extent(s).second, high);
  }
}

TEST(PackedHull, HoldsEachTriangleOnceInSpheresThatHoldIt) {
  const FluidBody body = test::boxBody({2, 1, 0.5}, 5);  // 300 triangles
  const PackedHull hull(body);
  const HullBlocks blocks = hull.blocks();
  ASSERT_EQ(blocks.count, 19u);
  Vector3 sum(0, 0, 0);
  double area = 0;
  for (std::size_t i = 0; i < blocks.count; ++i) {
    const HullMoments& group = blocks.moments[i / HullMoments::kBlocks];
    const std::size_t lane = i % HullMoments::kBlocks;
    const Vector3 centre(group.centre[0][lane], group.centre[1][lane], group.centre[2][lane]);
    for (int k = 0; k < HullBlock::kTriangles; ++k) {
      const auto& n = blocks.blocks[i].area_normal;
      const Vector3 normal(n[0][k], n[1][k], n[2][k]);
      sum += normal;
      area += normal.norm();
      if (normal.isZero(0)) continue;
      for (const auto& c : blocks.blocks[i].corner)
        EXPECT_LE((Vector3(c[0][k], c[1][k], c[2][k]) - centre).norm(), group.radius[lane]);
    }
  }
  EXPECT_NEAR(area, body.area, 1e-13);
  EXPECT_LT(sum.norm(), 1e-14);
}

TEST(PackedHull, SheetDisplacesNothing) {
  FluidBody sheet = test::boxBody({2, 1, 0.5});
  sheet.volume = 0;
  EXPECT_EQ(PackedHull(sheet).blocks().count, 0u);
  EXPECT_EQ(PackedHull(sheet).extent({0, 0, 1}).second, 0.25);
}

}  // namespace
}  // namespace ambient
