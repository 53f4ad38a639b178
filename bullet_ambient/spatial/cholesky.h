#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Cholesky's factor L of a symmetric positive definite matrix A = L L^T of N rows, N = 3 or 6.
/// Compiled once for all boxes: Eigen's own takes a second in each source.
template <int N>
class Cholesky {
 public:
  using Matrix = Eigen::Matrix<double, N, N, Eigen::DontAlign>;
  using Vector = Eigen::Matrix<double, N, 1, Eigen::DontAlign>;

  Cholesky() noexcept;  ///< of nothing: not positive
  /// Reads the lower half of `symmetric`.
  explicit Cholesky(const Matrix& symmetric) noexcept;

  /// False if the matrix is not positive definite; what the functions below return then means
  /// nothing.
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
