#pragma once

namespace ambient {

/// Makes the bits of Eigen's products and factorisations of large matrices the same on every
/// machine. Eigen sums in blocks that fit the processor's caches; from the first call on, these
/// count as 32 kB, 1 MB and 8 MB, in the whole program. To be called before such a product.
void fixBlocksOfLargeProducts();

}  // namespace ambient
