#include "preprocess/potential_flow/surface/shape_symmetry.h"

#include <gtest/gtest.h>

#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

std::size_t countOf(const TriangleMesh& mesh, const Vector3d& centre = Vector3d::Zero()) {
  return findSymmetries(mesh, centre).size();
}

TEST(ShapeSymmetry, DiagonalsOfFlatFacesDoNotHideTheMirrorsOfABox) {
  // Three mirrors and three half turns, in both sets of axes.
  const TriangleMesh box = makeBoxMesh({3, 2, 1}, 12);
  EXPECT_EQ(countOf(box), 12U);
  EXPECT_EQ(countOf(moved(box, {1, 2, 3}), {1, 2, 3}), 12U);
  EXPECT_EQ(countOf(rotated(box, someRotation())), 6U) << "by its principal axes alone";
  EXPECT_EQ(countOf(scaled(box, 1e-5)), 12U);
}

TEST(ShapeSymmetry, PlaneTrapezoidsOfATorusMayBeCutAlongAnyDiagonal) {
  EXPECT_GE(countOf(test::makeTorus({2, 1, 8, 8})), 6U);
}

TEST(ShapeSymmetry, TurnsWithoutMirrorsAndMirrorsWithoutTurns) {
  EXPECT_EQ(countOf(test::twisted(makeBoxMesh({1, 0.5, 0.7}, 48), 0.5)), 6U) << "three half turns";
  // Two mirrors and their product, a half turn.
  const TriangleMesh cone = makeConeMesh(1, 1, 64);
  for (const Eigen::Matrix3d& turn : findSymmetries(cone, Vector3d::Zero()))
    EXPECT_NEAR(turn(2, 2), 1, 1e-12);
  EXPECT_GE(countOf(cone), 3U);
}

TEST(ShapeSymmetry, AlmostSymmetricIsNotSymmetric) {
  EXPECT_EQ(countOf(test::skewBody(makeBoxMesh({0.5, 0.35, 0.6}, 48))), 0U);
  TriangleMesh dented = makeBoxMesh({3, 2, 1}, 12);
  dented.vertices(0, 0) += 1e-5;
  EXPECT_EQ(countOf(dented), 0U);
  EXPECT_EQ(countOf(makeBoxMesh({3, 2, 1}, 12), {1e-5, 1e-5, 1e-5}), 0U);
}

TEST(ShapeSymmetry, KeepsExactlyWhatTheMirrorsOfAConeAllow) {
  Matrix6 full;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) full(i, j) = 1 + std::min(i, j) + 7 * std::max(i, j);
  const Matrix6 K = symmetrised(full, {Vector3(-1, 1, 1).asDiagonal().toDenseMatrix(),
                                       Vector3(1, -1, 1).asDiagonal().toDenseMatrix()});
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      // x -> -x changes the sign of rotations about y, z and of translations along x.
      const bool coupled =
          (i == 0 && j == 4) || (i == 4 && j == 0) || (i == 1 && j == 3) || (i == 3 && j == 1);
      EXPECT_EQ(K(i, j), i == j || coupled ? full(i, j) : 0) << i << " " << j;
    }
}

}  // namespace
}  // namespace ambient
