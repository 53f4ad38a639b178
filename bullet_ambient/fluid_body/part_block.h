#pragma once

#include <cstddef>

namespace ambient {

/// Eight parts of the added mass, component by component: what the kernel of bodies at the surface
/// of the water reads. Plain data only. The last block ends with parts that are zero.
struct alignas(64) PartBlock {
  static constexpr int kParts = 8;
  static constexpr int kEntries = 21;
  double centre[3][kParts];
  double spread[6][kParts];          ///< xx, yy, zz, xy, xz, yz
  double inertia[kEntries][kParts];  ///< symmetric 6x6: rows from the diagonal on
};

struct PartBlocks {
  const PartBlock* blocks;
  std::size_t count;
};

}  // namespace ambient
