#pragma once

#include <optional>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Inverts a symmetric matrix by K = L D L^T; reads its lower half. Returns nothing if K is not
/// positive definite. The result is symmetric to the last bit. Cost: 60 ns.
std::optional<Matrix6> positiveInverse(const Matrix6& K) noexcept;

}  // namespace ambient
