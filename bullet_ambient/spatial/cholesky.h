#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Cholesky factors A = L L^T = M D M^T of a symmetric positive definite N x N matrix, N = 3 or 6;
/// M has ones on its diagonal. Loops of its own: Eigen's factorisation takes seconds to compile.
template <int N>
class Cholesky {
 public:
  using Matrix = Eigen::Matrix<double, N, N, Eigen::DontAlign>;
  using Vector = Eigen::Matrix<double, N, 1, Eigen::DontAlign>;

  Cholesky() noexcept = default;  ///< isPositive() is false
  /// Factorises A = `symmetric`, of which only the lower half is read.
  explicit Cholesky(const Matrix& symmetric) noexcept;

  /// False if the matrix is not positive definite; results of the functions below are then
  /// meaningless, and of a matrix that is not finite not finite.
  bool isPositive() const noexcept { return is_positive_; }
  Matrix lower() const noexcept;                     ///< L, zeros above the diagonal
  Vector solve(const Vector& right) const noexcept;  ///< A^-1 `right`
  Matrix inverse() const noexcept;                   ///< A^-1, symmetric to the last bit
  Matrix inverseTransposed() const noexcept;         ///< L^-T, zeros below the diagonal

 private:
  /// M^-1 below its diagonal; all else is 0.
  Matrix invertedUnit() const noexcept;

  Matrix unit_ = Matrix::Zero();           // M below its diagonal
  Vector inverse_pivot_ = Vector::Zero();  // 1 / D
  bool is_positive_ = false;
};

extern template class Cholesky<3>;
extern template class Cholesky<6>;

}  // namespace ambient
