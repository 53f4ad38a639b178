#include "bullet_ambient/fluid_body/packed_faces.h"

#include <gtest/gtest.h>

#include "tests/support/geodesic.h"

namespace ambient {
namespace {

FaceTable someFaces(int level = 1) { return test::faceTableOf(test::geodesicSphere(level)); }

TEST(PackedFaces, HoldEachFaceInSinglePrecision) {
  FaceTable faces = someFaces();  // 80: five blocks
  faces.add(Vector3::UnitX(), {3, -0.5, 0.25}, 7);
  const PackedFaces packed(faces);
  ASSERT_EQ(packed.blocks().size(), 6u);
  EXPECT_EQ(packed.size(), 81u);
  EXPECT_EQ(packed.lengthUnit(), 4);
  EXPECT_EQ(packed.areaUnit(), 8);
  const FaceBlock& last = packed.blocks().back();
  EXPECT_EQ(last.normal[0][0], 1);
  EXPECT_EQ(last.centroid[0][0], 0.75f);
  EXPECT_EQ(last.moment[1][0], 0.0625f);  // c x n = (0, c_z, -c_y)
  EXPECT_EQ(last.moment[2][0], 0.125f);
  EXPECT_EQ(last.area[0], 0.875f);
  EXPECT_EQ(packed.blocks()[1].normal[2][3], static_cast<float>(faces.normal_z[19]));
}

TEST(PackedFaces, FillTheLastBlockWithZeros) {
  FaceTable faces;
  faces.add(Vector3::UnitX(), {1, 1, 1}, 1);
  const PackedFaces packed(faces);
  const FaceBlock& block = packed.blocks().front();
  for (int i = 1; i < FaceBlock::kFaces; ++i) {
    EXPECT_EQ(block.area[i], 0);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(block.normal[axis][i] + block.centroid[axis][i] + block.moment[axis][i], 0);
  }
}

TEST(SharedPackedFaces, AreOnePerTable) {
  const FaceTable faces = someFaces();
  const auto packed = sharedPackedFaces(faces);
  EXPECT_EQ(sharedPackedFaces(faces), packed);
  const FaceTable same = faces;
  EXPECT_NE(sharedPackedFaces(same), packed);
}

TEST(SharedPackedFaces, FollowATableThatChanges) {
  FaceTable faces = someFaces();
  const auto before = sharedPackedFaces(faces);
  faces.area[7] *= 2;
  const auto after = sharedPackedFaces(faces);
  EXPECT_NE(after, before);
  EXPECT_TRUE(after->isOf(faces));
  EXPECT_FALSE(before->isOf(faces));
}

}  // namespace
}  // namespace ambient
