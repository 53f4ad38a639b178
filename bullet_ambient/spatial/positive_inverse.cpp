#include "bullet_ambient/spatial/positive_inverse.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/invariants.h"

namespace ambient {
namespace {

constexpr int kSize = 6;

/// Factors of K = L D L^T.
struct Factors {
  double lower[kSize][kSize];  // L below its diagonal of ones
  double per_pivot[kSize];     // 1 / D
};

// Factorises K row by row; returns false if a pivot is not positive.
bool factorise(const Matrix6& K, Factors& factors) {
  double scaled[kSize];  // a row of L D
  for (int i = 0; i < kSize; ++i) {
    double pivot = K(i, i);
    for (int j = 0; j < i; ++j) {
      scaled[j] = K(i, j);
      for (int k = 0; k < j; ++k) scaled[j] -= scaled[k] * factors.lower[j][k];
      factors.lower[i][j] = scaled[j] * factors.per_pivot[j];
      pivot -= scaled[j] * factors.lower[i][j];
    }
    if (!(pivot > 0)) return false;
    factors.per_pivot[i] = 1 / pivot;
  }
  return true;
}

// Replaces the strictly lower part of L by that of L^-1.
void invert(double (&lower)[kSize][kSize]) {
  for (int j = 0; j < kSize; ++j)
    for (int i = j + 1; i < kSize; ++i) {
      double sum = lower[i][j];
      for (int k = j + 1; k < i; ++k) sum += lower[i][k] * lower[k][j];
      lower[i][j] = -sum;
    }
}

}  // namespace

std::optional<Matrix6> positiveInverse(const Matrix6& K) noexcept {
  AMBIENT_ASSERT(isSymmetric(K, 1e-9));
  Factors factors;
  if (!factorise(K, factors)) return std::nullopt;
  invert(factors.lower);
  const auto& M = factors.lower;
  Matrix6 inverse;
  for (int j = 0; j < kSize; ++j)
    for (int i = 0; i <= j; ++i) {
      double sum = (i == j ? 1 : M[j][i]) * factors.per_pivot[j];
      for (int k = j + 1; k < kSize; ++k) sum += M[k][i] * M[k][j] * factors.per_pivot[k];
      inverse(i, j) = inverse(j, i) = sum;
    }
  return inverse;
}

}  // namespace ambient
