#include "bullet_ambient/spatial/cholesky.h"

#include <Eigen/Cholesky>

namespace ambient {

template <int N>
Cholesky<N>::Cholesky() noexcept : lower_(Matrix::Zero()) {}

template <int N>
Cholesky<N>::Cholesky(const Matrix& symmetric) noexcept {
  const Eigen::LLT<Matrix> factor(symmetric);
  lower_ = factor.matrixL();
  is_positive_ = factor.info() == Eigen::Success;
}

template <int N>
auto Cholesky<N>::solve(const Vector& right) const noexcept -> Vector {
  Vector x = right;
  lower_.template triangularView<Eigen::Lower>().solveInPlace(x);
  lower_.transpose().template triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

template <int N>
auto Cholesky<N>::inverse() const noexcept -> Matrix {
  Matrix inverse = Matrix::Identity();
  lower_.template triangularView<Eigen::Lower>().solveInPlace(inverse);
  lower_.transpose().template triangularView<Eigen::Upper>().solveInPlace(inverse);
  return inverse;
}

template <int N>
auto Cholesky<N>::inverseTransposed() const noexcept -> Matrix {
  Matrix inverse = Matrix::Identity();
  lower_.transpose().template triangularView<Eigen::Upper>().solveInPlace(inverse);
  return inverse;
}

template class Cholesky<3>;
template class Cholesky<6>;

}  // namespace ambient
