#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Returns an order of the indices 0 to N - 1 in which points that are close form blocks of
/// `block_size`. Halves the set across its widest coordinate down to one block; indices within a
/// block ascend. The last block may be smaller. Cost: O(N log N).
std::vector<std::uint32_t> orderInBlocks(const std::vector<Vector6>& coordinates,
                                         std::size_t block_size);

}  // namespace ambient
