#pragma once

#include <cstddef>

namespace ambient {

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

/// Bounds of all faces of a block, for sixteen blocks: of their 6-vectors (c x n, n), whose product
/// with the twist is the normal velocity of a face, and of their places. Bounds are rounded
/// outwards.
struct alignas(64) FaceBounds {
  static constexpr int kBlocks = 16;
  float middle[6][kBlocks];
  float reach[6][kBlocks];                     ///< largest distance from the middle
  float centre[3][kBlocks], half[3][kBlocks];  ///< box around the centroids: centre, half sides
  float radius[kBlocks];                       ///< of the largest disc with the area of a face
};

/// FormFactors of the faces of one block, for the form law; their arms in pitching,
/// FormShape::pitchingArm(), in units of length, 0 unless the shape is a wing.
struct alignas(64) FormBlock {
  float by_normal[FaceBlock::kFaces];
  float by_speed[FaceBlock::kFaces];
  float by_lee[FaceBlock::kFaces];
  float arm[FaceBlock::kFaces];
};

/// Blocks of a shape with their bounds.
struct FaceBlocks {
  const FaceBlock* blocks;
  const FaceBounds* bounds;
  std::size_t count;                ///< number of blocks
  const FormBlock* form = nullptr;  ///< one per block; null: the published law
  const double* lee = nullptr;      ///< 6 x 21, lee side of the form law: see addEvenPart()

  /// Returns the blocks from number `block` on, without bounds.
  FaceBlocks from(std::size_t block) const {
    return {blocks + block, nullptr, count - block, form ? form + block : nullptr, lee};
  }
};

}  // namespace ambient
