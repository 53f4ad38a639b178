#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/refusal_of.h"

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

// Bounds and the lee side serve the choice of blocks: they are left out where all are summed.
TEST(PackedFaces, OfFewBlocksKeepNoBoundsAndNoLeeSide) {
  for (const std::size_t blocks : {FaceBlocks::kFewestChosen - 1, FaceBlocks::kFewestChosen}) {
    FaceTable faces;
    for (std::size_t i = 0; i < FaceBlock::kFaces * blocks; ++i)
      faces.add(Vector3::UnitX(), {1, static_cast<double>(i), 0}, 1);
    faces.sharpness.assign(faces.size(), 1);
    const PackedFaces packed(faces, FormShape{});
    const FaceBlocks form = packed.blocks();
    EXPECT_EQ(form.count, blocks);
    EXPECT_EQ(form.bounds != nullptr, blocks >= FaceBlocks::kFewestChosen);
    EXPECT_EQ(form.lee != nullptr, blocks >= FaceBlocks::kFewestChosen);
    EXPECT_NE(form.sharpness, nullptr);
    EXPECT_EQ(form.arms, nullptr);
  }
}

TEST(PackedFaces, LieWithTheirDiscsWithinTheBoxOfTheirBlock) {
  const PackedFaces packed(someFaces(3));
  const FaceBlocks faces = packed.blocks();
  const double unit = packed.areaUnit() / (packed.lengthUnit() * packed.lengthUnit());
  for (std::size_t k = 0; k < faces.count; ++k) {
    const FaceBlock& block = faces.blocks[k];
    const FaceBoxes& boxes = faces.boxes[k / FaceBoxes::kBlocks];
    const std::size_t at = k % FaceBoxes::kBlocks;
    for (int axis = 0; axis < 3; ++axis) {
      const float* values = block.centroid[axis];
      const auto [low, high] = std::minmax_element(values, values + FaceBlock::kFaces);
      EXPECT_LT(boxes.centre[axis][at] - boxes.half[axis][at], *low);
      EXPECT_GT(boxes.centre[axis][at] + boxes.half[axis][at], *high);
      EXPECT_LT(2 * boxes.half[axis][at], *high - *low + 1e-5f);
    }
    const double area = static_cast<double>(*std::max_element(block.area, std::end(block.area)));
    const auto radius = static_cast<double>(boxes.radius[at]);
    EXPECT_GT(radius * radius, (1 + 1e-4) * area * unit / kPi);
    EXPECT_LT(radius, 1.001 * std::sqrt(area * unit / kPi) + 1e-5);
  }
}

using test::Arbitrary;

/// A closed surface without coplanar triangles.
FluidBody bumpyBody(int level) {
  Arbitrary arbitrary(1);
  test::Triangulation mesh = test::geodesicSphere(level);
  for (Vector3& v : mesh.vertices) v = arbitrary.between(0.7, 1.3) * v + Vector3(1, 2, 3);
  return test::hullBody(mesh);
}

Vector3 areaNormal(const HullBlock& block, int triangle) {
  const auto corner = [&](int k) {
    const auto& c = block.corner[k];
    return Vector3(c[0][triangle], c[1][triangle], c[2][triangle]);
  };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0)) / 2;
}

TEST(PackedHull, HoldsEachTriangleOnceInBoxesThatHoldIt) {
  const FluidBody body = bumpyBody(2);  // 320 triangles
  const PackedHull hull(body);
  const HullBlocks blocks = hull.blocks();
  ASSERT_EQ(blocks.count, 40u);
  Vector3 sum(0, 0, 0);
  double area = 0;
  for (std::size_t i = 0; i < blocks.count; ++i) {
    const HullBoxes& group = blocks.boxes[i / HullBoxes::kBlocks];
    const std::size_t lane = i % HullBoxes::kBlocks;
    for (int k = 0; k < HullBlock::kTriangles; ++k) {
      const Vector3 normal = areaNormal(blocks.blocks[i], k);
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
    for (int k = 0; k < HullBlock::kTriangles; ++k)
      area += areaNormal(hull.blocks().blocks[i], k).norm();
  EXPECT_NEAR(area, 7, 1e-14);
  EXPECT_EQ(hull.corners().count, 1u);
}

TEST(PackedHull, SheetDisplacesNothing) {
  FluidBody sheet = test::boxBody({2, 1, 0.5});
  sheet.volume = 0;
  EXPECT_EQ(PackedHull(sheet).blocks().count, 0u);
  EXPECT_EQ(PackedHull(sheet).corners().count, 1u);
}

double shareOf(const OctahedralLattice::Corners& place, int node) {
  double share = 0;
  for (int corner = 0; corner < 3; ++corner)
    if (place.node[corner] == node) share += place.weight[corner];
  return share;
}

TEST(OctahedralLattice, HasEveryDirectionOnceAndFindsItAgain) {
  for (const int subdivisions : {1, 2, 3, 4, 7}) {
    const OctahedralLattice lattice(subdivisions);
    ASSERT_EQ(lattice.size(), 4 * subdivisions * subdivisions + 2);
    for (int node = 0; node < lattice.size(); ++node) {
      const Vector3 s = lattice.direction(node);
      EXPECT_NEAR(s.norm(), 1, 1e-15);
      EXPECT_NEAR(shareOf(lattice.cornersAround(s), node), 1, 1e-12)
          << subdivisions << ", " << node;
      const Vector3 point = s * (subdivisions / s.cwiseAbs().sum());
      EXPECT_LT((point - Vector3(point.array().round())).norm(), 1e-12);
    }
  }
}

// Interpolation must reproduce linear functions exactly, on each of the eight faces.
TEST(OctahedralLattice, SharesAreLinearOnTheOctahedron) {
  test::Arbitrary arbitrary(1);
  for (const int subdivisions : {1, 4, 5}) {
    const OctahedralLattice lattice(subdivisions);
    for (int i = 0; i < 1000; ++i) {
      const Vector3 direction = arbitrary.vector();
      const OctahedralLattice::Corners place = lattice.cornersAround(direction);
      Vector3 mean = Vector3::Zero();
      for (int corner = 0; corner < 3; ++corner) {
        ASSERT_GE(place.node[corner], 0);
        ASSERT_LT(place.node[corner], lattice.size());
        EXPECT_GE(place.weight[corner], -1e-12);
        const Vector3 s = lattice.direction(place.node[corner]);
        mean += place.weight[corner] * s / s.cwiseAbs().sum();
      }
      EXPECT_LT((mean - direction / direction.cwiseAbs().sum()).norm(), 1e-14);
    }
  }
}

TEST(OctahedralLattice, AxesEdgesAndCornersOfItsFacesAreNoExceptions) {
  const OctahedralLattice lattice(4);
  for (const double x : {-1.0, -0.5, -0.0, 0.0, 1e-17, 0.5, 1.0})
    for (const double y : {-1.0, -1e-17, 0.0, 1.0 / 3, 1.0})
      for (const double z : {-1.0, 0.0, 1e-300, 1.0}) {
        const Vector3 direction(x, y, z);
        if (direction.isZero(0)) continue;
        const OctahedralLattice::Corners place = lattice.cornersAround(direction);
        EXPECT_NEAR(place.weight[0] + place.weight[1] + place.weight[2], 1, 1e-14);
        for (const int node : place.node) {
          EXPECT_GE(node, 0);
          EXPECT_LT(node, lattice.size());
        }
      }
}

FluidBody bodyOf(const test::Triangulation& mesh) {
  FluidBody body;
  body.name = "round";
  body.faces = test::faceTableOf(mesh);
  body.area = test::totalArea(body.faces);
  for (const Vector3& vertex : mesh.vertices)
    body.surface.vertices.insert(body.surface.vertices.end(), vertex.begin(), vertex.end());
  for (const Eigen::Vector3i& triangle : mesh.triangles)
    body.surface.triangles.own().insert(body.surface.triangles.end(), triangle.begin(),
                                        triangle.end());
  return body;
}

TEST(Sharpness, OfASphereIsZeroForEveryTriangulation) {
  double before = 1;
  for (const int level : {1, 2, 3}) {
    const std::vector<double> s = computeSharpness(bodyOf(test::geodesicSphere(level)));
    const double largest = *std::max_element(s.begin(), s.end());
    EXPECT_LT(largest, before / 8) << level;  // area of the mesh slightly too small
    before = largest;
  }
  EXPECT_LT(before, 1e-5);
}

TEST(Sharpness, DoesNotDependOnTheScale) {
  const FluidBody body = bodyOf(test::geodesicEllipsoid({1, 2, 5}, 2));
  EXPECT_EQ(computeSharpness(scaled(body, 1024)), computeSharpness(body));
}

TEST(Sharpness, OfASpheroidIsThatOfItsCurvature) {
  // At the pole of an oblate spheroid both curvatures are b/a^2.
  const FluidBody body = bodyOf(test::geodesicEllipsoid({2, 2, 1}, 4));
  const std::vector<double> s = computeSharpness(body);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < body.faces.size(); ++i)
    if (body.faces.centroid_z[i] > 0.99) {
      sum += s[i];
      ++count;
    }
  const double x = 0.25 * std::sqrt(body.area / (4 * 3.14159265358979));
  const double root = (1 - x * x) / (1 + x * x);
  ASSERT_GT(count, 10);
  EXPECT_NEAR(sum / count, root * root, 0.02);
}

TEST(Sharpness, TakesVerticesAtOnePlaceForOne) {
  const FluidBody body = bodyOf(test::geodesicSphere(2));
  FluidBody apart = body;
  apart.surface.vertices.clear();
  for (std::size_t i = 0; i < body.surface.triangles.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(body.surface.triangles[i]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      apart.surface.vertices.push_back(body.surface.vertices[3 * vertex + axis]);
  }
  std::vector<std::int32_t>& numbers = apart.surface.triangles.own();
  std::iota(numbers.begin(), numbers.end(), 0);
  EXPECT_EQ(computeSharpness(apart), computeSharpness(body));
}

TEST(Sharpness, IsOneOnTheHollowSideOfASheet) {
  FluidBody shell = bodyOf(test::geodesicSphere(2));
  const std::size_t count = shell.faces.size();
  for (std::size_t i = 0; i < count; ++i)
    shell.faces.add(-shell.faces.normal(i), shell.faces.centroid(i), shell.faces.area[i]);
  const std::vector<double> s = computeSharpness(shell);
  ASSERT_EQ(s.size(), 2 * count);
  EXPECT_LT(*std::max_element(s.begin(), s.begin() + static_cast<std::ptrdiff_t>(count)), 0.05);
  EXPECT_EQ(*std::min_element(s.begin() + static_cast<std::ptrdiff_t>(count), s.end()), 1);
}

TEST(Sharpness, IsOneOfFacesWithoutASurface) {
  FluidBody body = bodyOf(test::geodesicSphere(0));
  body.surface = {};
  EXPECT_EQ(computeSharpness(body), std::vector<double>(20, 1));
}

TEST(Sharpness, NeedsTheTrianglesOfTheFaces) {
  FluidBody body = bodyOf(test::geodesicSphere(0));
  body.surface.triangles.own().resize(27);
  EXPECT_EQ(test::refusalOf<std::invalid_argument>([&] { computeSharpness(body); }),
            "fluid body 'round': number of its faces is 20, must be that of the triangles of its "
            "surface, or twice that of a sheet's, for the form law");
}

TEST(FormLawFaces, TakeAKnownSharpnessWithoutASurface) {
  FluidBody body = bodyOf(test::geodesicSphere(1));
  body.faces.sharpness.assign(body.faces.size(), 0.25);
  body.surface = {};
  EXPECT_EQ(formLawFaces(body, {}).sharpness, body.faces.sharpness);
}

}  // namespace
}  // namespace ambient
