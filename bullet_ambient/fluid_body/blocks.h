#pragma once

#include <cstddef>

namespace ambient {

/// Eight parts of the added mass, component by component, in single precision: input of the kernel
/// for bodies at the surface of the water, which sums in double. Plain data only. The last block is
/// filled up with zeros.
struct alignas(64) PartBlock {
  static constexpr int kParts = 8;
  static constexpr int kEntries = 21;
  float centre[3][kParts];
  float reach[kParts];              ///< largest distance from the centre of a part's Gauss points
  float spread[6][kParts];          ///< xx, yy, zz, xy, xz, yz
  float inertia[kEntries][kParts];  ///< symmetric 6x6: upper triangle, row by row
};

/// Axes, as bits, along which a mirror turns the sign of a component of a motion, rotation first.
constexpr int kTurnedBy[6] = {6, 5, 3, 1, 2, 4};

struct PartBlocks {
  const PartBlock* blocks;
  std::size_t count;
  /// Axes, as bits: planes through the origin across them mirror the body; the blocks hold one part
  /// of all images.
  int mirrors = 0;
  /// Shares of the parts of one block that are in a pool, image by image, see imageOf(). Null: the
  /// whole parts are.
  const double* shares = nullptr;

  [[gnu::always_inline]] int images() const {
    return (1 + (mirrors & 1)) * (1 + (mirrors >> 1 & 1)) * (1 + (mirrors >> 2));
  }
};

/// Returns the axes, as bits, that image number `image` of a body with mirrors turns.
[[gnu::always_inline]] constexpr int imageOf(int mirrors, int image) {
  int turned = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(mirrors >> axis & 1)) continue;
    turned |= (image & 1) << axis;
    image /= 2;
  }
  return turned;
}

/// Sixteen faces in single precision, component by component: input of the load kernels. Plain
/// data only, because the kernels are compiled once per instruction set. Units of length and area:
/// those of PackedFaces. The last block of a shape is filled up with zeros.
struct alignas(64) FaceBlock {
  static constexpr int kFaces = 16;
  float normal[3][kFaces];    ///< unit normals n
  float centroid[3][kFaces];  ///< c, components in [-1, 1]
  float moment[3][kFaces];    ///< c x n
  float area[kFaces];         ///< in [0, 1]
};

/// Bounds of the places of all faces of a block, for sixteen blocks, rounded outwards.
struct alignas(64) FaceBoxes {
  static constexpr int kBlocks = 16;
  float centre[3][kBlocks], half[3][kBlocks];  ///< box around the centroids: centre, half sides
  float radius[kBlocks];                       ///< of the largest disc with the area of a face
};

/// Bounds of the 6-vectors (c x n, n) of all faces of a block, whose product with the twist is the
/// normal velocity of a face, for sixteen blocks, rounded outwards.
struct alignas(64) FaceBounds {
  static constexpr int kBlocks = FaceBoxes::kBlocks;
  float middle[6][kBlocks];
  float reach[6][kBlocks];  ///< largest distance from the middle
};

/// One number of each face of a block.
struct alignas(64) FaceColumn {
  float of[FaceBlock::kFaces];
};

/// Blocks of a shape with their bounds.
struct FaceBlocks {
  /// Number of blocks from which on those with attached flow are chosen. Fewer are summed all: to
  /// choose costs more than it saves.
  static constexpr std::size_t kFewestChosen = 12;

  const FaceBlock* blocks;
  const FaceBoxes* boxes;
  std::size_t count;                      ///< number of blocks
  const FaceBounds* bounds = nullptr;     ///< null: the blocks are too few
  const FaceColumn* sharpness = nullptr;  ///< one per block; null: the published law
  /// One per block: arms in pitching, FormShape::pitchingArm(), in units of length; null: no wing.
  const FaceColumn* arms = nullptr;
  /// 6 x 21, lee side of the form law, see addQuadraticPart(); null: the blocks are too few.
  const double* lee = nullptr;

  /// Returns the blocks from number `block` on, without places and bounds.
  FaceBlocks from(std::size_t block) const {
    const auto after = [block](const FaceColumn* columns) {
      return columns ? columns + block : nullptr;
    };
    return {blocks + block, nullptr, count - block, nullptr, after(sharpness), after(arms), lee};
  }
};

/// Eight triangles of a closed surface, component by component: input of the hydrostatics kernels.
/// Plain data only, like FaceBlock, but in double precision: the energy of a floating body is a
/// small difference. In frame F. The last block is filled up with triangles of area 0.
struct alignas(64) HullBlock {
  static constexpr int kTriangles = 8;
  double corner[3][3][kTriangles];  ///< corner by corner, counter-clockwise from outside [m]
};

/// Axis-aligned boxes around the triangles of eight blocks.
struct alignas(64) HullBoxes {
  static constexpr int kBlocks = 8;
  double centre[3][kBlocks], half[3][kBlocks];  ///< centres, half sides [m]
};

/// Integrals over the triangles of one block, docs/theory.md eq. (57).
struct HullMoments {
  static constexpr int kNumbers = 10;
  double of[3][kNumbers];  ///< for each j: N_j; M_jk; Q_jkl, k <= l
};

/// Symmetry of a hull that is kept in part: quarter turns about an axis through the origin. Image
/// number i of the part is turned i times.
struct HullSymmetry {
  int axis = -1;  ///< -1: all of the hull is kept

  [[gnu::always_inline]] int images() const { return axis < 0 ? 1 : 4; }
  /// Returns the image of a vector.
  template <class Vector>
  [[gnu::always_inline]] Vector imageOf(Vector v, int image) const {
    const int first = (axis + 1) % 3, second = (axis + 2) % 3;
    for (; image > 0; --image) {
      const auto x = v[first];
      v[first] = -v[second];
      v[second] = x;
    }
    return v;
  }
  /// Returns the vector whose image is `v`.
  template <class Vector>
  [[gnu::always_inline]] Vector seenFrom(Vector v, int image) const {
    return imageOf(v, (4 - image) % 4);
  }
};

/// Box and integrals over all triangles that are kept of a symmetric hull.
struct HullWhole {
  double centre[3], half[3];  ///< as in HullBoxes [m]
  HullMoments moments;
};

/// Blocks of a hull with their boxes and moments.
struct HullBlocks {
  const HullBlock* blocks;
  const HullBoxes* boxes;
  const HullMoments* moments;
  std::size_t count;                 ///< number of blocks
  HullSymmetry symmetry = {};        ///< of what the blocks hold a part of
  const HullWhole* whole = nullptr;  ///< null: all of the hull is kept
};

/// Corners of a hull in an axis-aligned box; unused lanes repeat the last corner.
struct alignas(64) HullPoints {
  static constexpr int kPoints = 16;
  double place[3][kPoints];   ///< [m]
  double centre[3], half[3];  ///< centre and half sides of the box [m]
};

struct HullCorners {
  const HullPoints* blocks;
  std::size_t count;           ///< number of blocks
  HullSymmetry symmetry = {};  ///< of what the blocks hold a part of
};

}  // namespace ambient
