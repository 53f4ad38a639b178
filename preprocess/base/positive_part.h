#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Nearest symmetric positive semi-definite matrix: negative eigenvalues become 0. Discretisation
/// leaves tiny negative eigenvalues in the inertia of a fluid where the true ones are zero.
/// @pre rotation and translation block are of similar size: unit of length = size of the body
Matrix6 positivePart(const Matrix6& K);

}  // namespace ambient
