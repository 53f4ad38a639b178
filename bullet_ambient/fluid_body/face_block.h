#pragma once

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

}  // namespace ambient
