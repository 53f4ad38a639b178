#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// The nearest symmetric positive semi-definite matrix. The inertia of a fluid is one; its
/// discretisation may leave tiny negative eigenvalues where the true ones are zero.
/// @pre rotation and translation have entries of similar size: lengths in units of the body's.
Matrix6 positivePart(const Matrix6& K);

}  // namespace ambient
