#pragma once

#include <cstddef>

namespace ambient {

/// Eight triangles of a closed surface, component by component: what the kernels of hydrostatics
/// read. Plain data only, as FaceBlock, but in double precision: the energy of a floating body is a
/// small difference. In frame F. The last block of a hull ends with triangles that are zero.
struct alignas(64) HullBlock {
  static constexpr int kTriangles = 8;
  double corner[3][3][kTriangles];    ///< corner by corner, counter-clockwise from outside [m]
  double area_normal[3][kTriangles];  ///< A n, out of the body [m^2]
};

/// Of eight blocks: a box around each, along the axes, and its integrals over the surface,
/// docs/theory.md eq. (57).
struct alignas(64) HullMoments {
  static constexpr int kBlocks = 8;
  static constexpr int kNumbers = 30;
  static constexpr double kNoBlock = -1;
  double centre[3][kBlocks];          ///< [m]
  double half[3][kBlocks];            ///< of its sides [m]; kNoBlock where the hull has ended
  double moments[kNumbers][kBlocks];  ///< N_j; M_jk, row by row; Q_jkl, k <= l
};

/// The blocks of a hull with their moments.
struct HullBlocks {
  const HullBlock* blocks;
  const HullMoments* moments;
  std::size_t count;  ///< of blocks
};

/// Corners of a hull in a box along the axes; the last one repeated where there are no more.
struct alignas(64) HullPoints {
  static constexpr int kPoints = 32;
  double place[3][kPoints];   ///< [m]
  double centre[3], half[3];  ///< of the box [m]
};

struct HullCorners {
  const HullPoints* blocks;
  std::size_t count;  ///< of blocks
};

}  // namespace ambient
