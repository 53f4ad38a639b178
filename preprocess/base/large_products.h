#pragma once

namespace ambient {

/// Makes Eigen's products and factorisations of large matrices give the same bits on every
/// machine. Eigen sums in blocks that fit the processor's caches. The first call sets the cache
/// sizes to 32 kB, 1 MB and 8 MB for the whole program. Call before the first such product.
void fixBlocksOfLargeProducts();

}  // namespace ambient
