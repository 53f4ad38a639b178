#include "bullet_ambient/fluid_body/packed/packed_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "tests/support/bodies/geodesic.h"

namespace ambient {
namespace {

FaceTable someFaces(int level = 1) { return test::faceTableOf(test::geodesicSphere(level)); }

// Block and lane of the only face with an area, in units of the area.
std::pair<const FaceBlock*, int> placeOf(const PackedFaces& packed, float area) {
  std::pair<const FaceBlock*, int> place(nullptr, 0);
  const FaceBlocks faces = packed.blocks();
  for (const FaceBlock* block = faces.blocks; block != faces.blocks + faces.count; ++block)
    for (int i = 0; i < FaceBlock::kFaces; ++i)
      if (block->area[i] == area) {
        EXPECT_EQ(place.first, nullptr) << area;
        place = {block, i};
      }
  return place;
}

TEST(PackedFaces, HoldEachFaceInSinglePrecisionOnce) {
  FaceTable faces = someFaces();  // 80: five blocks
  faces.add(Vector3::UnitX(), {3, -0.5, 0.25}, 7);
  for (std::size_t i = 0; i < 80; ++i) faces.area[i] = 0.01 * static_cast<double>(i + 1);
  const PackedFaces packed(faces);
  ASSERT_EQ(packed.blocks().count, 6u);
  EXPECT_EQ(packed.size(), 81u);
  EXPECT_EQ(packed.lengthUnit(), 4);
  EXPECT_EQ(packed.areaUnit(), 8);
  for (std::size_t i = 0; i < 81; ++i) {
    const auto [block, lane] = placeOf(packed, static_cast<float>(faces.area[i] / 8));
    ASSERT_NE(block, nullptr) << i;
    EXPECT_EQ(block->normal[2][lane], static_cast<float>(faces.normal_z[i]));
    EXPECT_EQ(block->centroid[1][lane], static_cast<float>(faces.centroid_y[i] / 4));
  }
  const auto [block, lane] = placeOf(packed, 0.875f);
  EXPECT_EQ(block->normal[0][lane], 1);
  EXPECT_EQ(block->centroid[0][lane], 0.75f);
  EXPECT_EQ(block->moment[1][lane], 0.0625f);  // c x n = (0, c_z, -c_y)
  EXPECT_EQ(block->moment[2][lane], 0.125f);
}

TEST(PackedFaces, FillTheLastBlockWithZeros) {
  FaceTable faces;
  faces.add(Vector3::UnitX(), {1, 1, 1}, 1);
  const PackedFaces packed(faces);
  const FaceBlock& block = packed.blocks().blocks[0];
  for (int i = 1; i < FaceBlock::kFaces; ++i) {
    EXPECT_EQ(block.area[i], 0);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(block.normal[axis][i] + block.centroid[axis][i] + block.moment[axis][i], 0);
  }
}

TEST(PackedFaces, LieWithinTheBoundsOfTheirBlock) {
  const PackedFaces packed(someFaces(3));  // 80 blocks
  const FaceBlocks faces = packed.blocks();
  ASSERT_EQ(faces.count, 80u);
  for (std::size_t k = 0; k < faces.count; ++k) {
    const FaceBlock& block = faces.blocks[k];
    const FaceBounds& bounds = faces.bounds[k / FaceBounds::kBlocks];
    for (int row = 0; row < 6; ++row) {
      const float* values = row < 3 ? block.moment[row] : block.normal[row - 3];
      const auto [low, high] = std::minmax_element(values, values + FaceBlock::kFaces);
      const float middle = bounds.middle[row][k % FaceBounds::kBlocks];
      const float reach = bounds.reach[row][k % FaceBounds::kBlocks];
      EXPECT_LT(middle - reach, *low);
      EXPECT_GT(middle + reach, *high);
      EXPECT_LT(2 * reach, *high - *low + 1e-5f);
      EXPECT_LT(reach, 0.3f);  // 16 similar faces of 1280
    }
  }
}

TEST(PackedFaces, LieWithTheirDiscsWithinTheBoxOfTheirBlock) {
  const PackedFaces packed(someFaces(3));
  const FaceBlocks faces = packed.blocks();
  const double unit = packed.areaUnit() / (packed.lengthUnit() * packed.lengthUnit());
  for (std::size_t k = 0; k < faces.count; ++k) {
    const FaceBlock& block = faces.blocks[k];
    const FaceBounds& bounds = faces.bounds[k / FaceBounds::kBlocks];
    const std::size_t at = k % FaceBounds::kBlocks;
    for (int axis = 0; axis < 3; ++axis) {
      const float* values = block.centroid[axis];
      const auto [low, high] = std::minmax_element(values, values + FaceBlock::kFaces);
      EXPECT_LT(bounds.centre[axis][at] - bounds.half[axis][at], *low);
      EXPECT_GT(bounds.centre[axis][at] + bounds.half[axis][at], *high);
      EXPECT_LT(2 * bounds.half[axis][at], *high - *low + 1e-5f);
    }
    const double area = static_cast<double>(*std::max_element(block.area, std::end(block.area)));
    const auto radius = static_cast<double>(bounds.radius[at]);
    EXPECT_GT(radius * radius, (1 + 1e-4) * area * unit / kPi);
    EXPECT_LT(radius, 1.001 * std::sqrt(area * unit / kPi) + 1e-5);
  }
}

}  // namespace
}  // namespace ambient
