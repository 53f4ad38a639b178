#pragma once

#include <optional>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// The inverse of a symmetric matrix, of which the lower half is read; nothing if it is not
/// positive definite. By K = L D L^T. Symmetric to the last bit. Cost: 60 ns.
std::optional<Matrix6> positiveInverse(const Matrix6& K) noexcept;

}  // namespace ambient
