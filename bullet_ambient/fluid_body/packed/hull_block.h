#pragma once

#include <cstddef>

namespace ambient {

/// Eight triangles of a closed surface, component by component: input of the hydrostatics kernels.
/// Plain data only, like FaceBlock, but in double precision: the energy of a floating body is a
/// small difference. In frame F. The last block is filled up with triangles of area 0.
struct alignas(64) HullBlock {
  static constexpr int kTriangles = 8;
  double corner[3][3][kTriangles];  ///< corner by corner, counter-clockwise from outside [m]
};

/// Moments of eight blocks: per block an axis-aligned box around the triangles, and integrals over
/// the triangles, docs/theory.md eq. (57).
struct alignas(64) HullMoments {
  static constexpr int kBlocks = 8;
  static constexpr int kNumbers = 30;
  static constexpr double kNoBlock = -1;
  double centre[3][kBlocks];          ///< centre of the box [m]
  double half[3][kBlocks];            ///< half sides of the box [m]; kNoBlock in unused lanes
  double moments[kNumbers][kBlocks];  ///< N_j; M_jk, row by row; Q_jkl, k <= l
};

/// Blocks of a hull with their moments.
struct HullBlocks {
  const HullBlock* blocks;
  const HullMoments* moments;
  std::size_t count;  ///< number of blocks
};

/// Corners of a hull in an axis-aligned box; unused lanes repeat the last corner.
struct alignas(64) HullPoints {
  static constexpr int kPoints = 32;
  double place[3][kPoints];   ///< [m]
  double centre[3], half[3];  ///< centre and half sides of the box [m]
};

struct HullCorners {
  const HullPoints* blocks;
  std::size_t count;  ///< number of blocks
};

}  // namespace ambient
