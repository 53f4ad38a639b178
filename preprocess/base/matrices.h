#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Nearest symmetric positive semi-definite matrix: negative eigenvalues become 0. Discretisation
/// leaves tiny negative eigenvalues in the inertia of a fluid where the true ones are zero.
/// @pre rotation and translation block are of similar size: unit of length = size of the body
Matrix6 positivePart(const Matrix6& K);

/// Makes Eigen's products and factorisations of large matrices give the same bits on every
/// machine. Eigen sums in blocks that fit the processor's caches. The first call sets the cache
/// sizes to 32 kB, 1 MB and 8 MB for the whole program. Call before the first such product.
void fixBlocksOfLargeProducts();

}  // namespace ambient
