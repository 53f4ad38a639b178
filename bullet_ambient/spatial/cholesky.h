#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Cholesky factor L of a symmetric positive definite N x N matrix A = L L^T, N = 3 or 6.
/// Compiled once for all targets: Eigen's factorisation takes a second in each source.
template <int N>
class Cholesky {
 public:
  using Matrix = Eigen::Matrix<double, N, N, Eigen::DontAlign>;
  using Vector = Eigen::Matrix<double, N, 1, Eigen::DontAlign>;

  Cholesky() noexcept;  ///< L = 0; isPositive() is false
  /// Factorises A = `symmetric`, of which only the lower half is read.
  explicit Cholesky(const Matrix& symmetric) noexcept;

  /// False if the matrix is not positive definite; results of the functions below are then
  /// undefined.
  bool isPositive() const noexcept { return is_positive_; }
  const Matrix& lower() const noexcept { return lower_; }  ///< L, zeros above the diagonal
  Vector solve(const Vector& right) const noexcept;        ///< A^-1 `right`
  Matrix inverse() const noexcept;                         ///< A^-1, symmetric to rounding
  Matrix inverseTransposed() const noexcept;               ///< L^-T, zeros below the diagonal

 private:
  Matrix lower_;
  bool is_positive_ = false;
};

extern template class Cholesky<3>;
extern template class Cholesky<6>;

}  // namespace ambient
