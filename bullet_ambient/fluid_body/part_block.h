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

struct PartBlocks {
  const PartBlock* blocks;
  std::size_t count;
  const double* shares = nullptr;  ///< of the parts of one block that are in a pool; null: all
};

}  // namespace ambient
