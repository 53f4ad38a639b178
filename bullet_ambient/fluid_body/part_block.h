#pragma once

#include <cstddef>

namespace ambient {

/// Eight parts of the added mass, component by component: input of the kernel for bodies at the
/// surface of the water. Plain data only. The last block is filled up with zeros.
struct alignas(64) PartBlock {
  static constexpr int kParts = 8;
  static constexpr int kEntries = 21;
  double centre[3][kParts];
  double reach[kParts];              ///< largest distance from the centre of a part's Gauss points
  double spread[6][kParts];          ///< xx, yy, zz, xy, xz, yz
  double inertia[kEntries][kParts];  ///< symmetric 6x6: upper triangle, row by row
};

struct PartBlocks {
  const PartBlock* blocks;
  std::size_t count;
};

}  // namespace ambient
