#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Puts things that are alike next to each other, for blocks of a given size: by halves, across the
/// widest of their coordinates, until a block is left; in a block by their numbers. The last block
/// may be smaller. Cost: O(N log N).
std::vector<std::uint32_t> orderInBlocks(const std::vector<Vector6>& coordinates,
                                         std::size_t block_size);

}  // namespace ambient
