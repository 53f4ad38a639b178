#pragma once

#include <cstddef>

namespace ambient {

/// Sixteen faces in single precision, component by component: what the load kernels read. Plain
/// data only, because the kernels are compiled once per instruction set. Lengths and areas in the
/// units of PackedFaces. The last block of a shape ends with faces that are zero.
struct alignas(64) FaceBlock {
  static constexpr int kFaces = 16;
  float normal[3][kFaces];    ///< unit normals n
  float centroid[3][kFaces];  ///< c, components in [-1, 1]
  float moment[3][kFaces];    ///< c x n
  float area[kFaces];         ///< in [0, 1]
};

/// Where the (c x n, n) of the faces of sixteen blocks lie, block by block: the normal velocity of
/// a face is its product with the motion. Rounded away from the faces.
struct alignas(64) FaceBounds {
  static constexpr int kBlocks = 16;
  float middle[6][kBlocks];
  float reach[6][kBlocks];  ///< to either side
};

/// The FormFactors of the faces of a block, for the form law.
struct alignas(64) FormBlock {
  float by_normal[FaceBlock::kFaces];
  float by_speed[FaceBlock::kFaces];
  float by_lee[FaceBlock::kFaces];
};

/// The blocks of a shape with their bounds.
struct FaceBlocks {
  const FaceBlock* blocks;
  const FaceBounds* bounds;
  std::size_t count;                ///< of blocks
  const FormBlock* form = nullptr;  ///< null: the published law
  const double* lee = nullptr;      ///< of the form law, without a surface: see addEvenPart()

  /// Those from a block on, without bounds.
  FaceBlocks from(std::size_t block) const {
    return {blocks + block, nullptr, count - block, form ? form + block : nullptr, lee};
  }
};

}  // namespace ambient
