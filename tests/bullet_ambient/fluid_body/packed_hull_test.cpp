#include "bullet_ambient/fluid_body/packed/packed_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;

/// A closed surface without coplanar triangles.
FluidBody bumpyBody(int level) {
  Arbitrary arbitrary(1);
  test::Triangulation mesh = test::geodesicSphere(level);
  for (Vector3& v : mesh.vertices) v = arbitrary.between(0.7, 1.3) * v + Vector3(1, 2, 3);
  return test::hullBody(mesh);
}

TEST(PackedHull, HoldsEachTriangleOnceInBoxesThatHoldIt) {
  const FluidBody body = bumpyBody(2);  // 320 triangles
  const PackedHull hull(body);
  const HullBlocks blocks = hull.blocks();
  ASSERT_EQ(blocks.count, 40u);
  Vector3 sum(0, 0, 0);
  double area = 0;
  for (std::size_t i = 0; i < blocks.count; ++i) {
    const HullMoments& group = blocks.moments[i / HullMoments::kBlocks];
    const std::size_t lane = i % HullMoments::kBlocks;
    for (int k = 0; k < HullBlock::kTriangles; ++k) {
      const auto& n = blocks.blocks[i].area_normal;
      const Vector3 normal(n[0][k], n[1][k], n[2][k]);
      sum += normal;
      area += normal.norm();
      for (const auto& c : blocks.blocks[i].corner)
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_LE(std::abs(c[axis][k] - group.centre[axis][lane]), group.half[axis][lane]);
    }
  }
  EXPECT_NEAR(area, body.area, 1e-13);
  EXPECT_LT(sum.norm(), 1e-14);
}

TEST(PackedHull, FlatSidesAreFansOfTheirCorners) {
  const PackedHull hull(test::boxBody({2, 1, 0.5}, 5));  // 300 triangles: two for each side
  ASSERT_EQ(hull.blocks().count, 2u);
  double area = 0;
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < HullBlock::kTriangles; ++k) {
      const auto& n = hull.blocks().blocks[i].area_normal;
      area += Vector3(n[0][k], n[1][k], n[2][k]).norm();
    }
  EXPECT_NEAR(area, 7, 1e-14);
  EXPECT_EQ(hull.corners().count, 1u);
}

TEST(PackedHull, SheetDisplacesNothing) {
  FluidBody sheet = test::boxBody({2, 1, 0.5});
  sheet.volume = 0;
  EXPECT_EQ(PackedHull(sheet).blocks().count, 0u);
  EXPECT_EQ(PackedHull(sheet).corners().count, 1u);
}

}  // namespace
}  // namespace ambient
