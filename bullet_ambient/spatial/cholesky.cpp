#include "bullet_ambient/spatial/cholesky.h"

#include <cmath>

namespace ambient {

template <int N>
Cholesky<N>::Cholesky(const Matrix& A) noexcept {
  double scaled[N] = {};  // a row of M D
  is_positive_ = true;
  for (int i = 0; i < N; ++i) {
    double pivot = A(i, i);
    for (int j = 0; j < i; ++j) {
      scaled[j] = A(i, j);
      for (int k = 0; k < j; ++k) scaled[j] -= scaled[k] * unit_(j, k);
      unit_(i, j) = scaled[j] * inverse_pivot_[j];
      pivot -= scaled[j] * unit_(i, j);
    }
    is_positive_ = is_positive_ && pivot > 0;
    inverse_pivot_[i] = 1 / pivot;
  }
}

template <int N>
auto Cholesky<N>::lower() const noexcept -> Matrix {
  Matrix lower = unit_;
  for (int j = 0; j < N; ++j) {
    const double root = std::sqrt(1 / inverse_pivot_[j]);
    lower(j, j) = root;
    for (int i = j + 1; i < N; ++i) lower(i, j) *= root;
  }
  return lower;
}

template <int N>
auto Cholesky<N>::solve(const Vector& right) const noexcept -> Vector {
  Vector x = right;
  for (int i = 1; i < N; ++i)
    for (int j = 0; j < i; ++j) x[i] -= unit_(i, j) * x[j];
  for (int i = N - 1; i >= 0; --i) {
    x[i] *= inverse_pivot_[i];
    for (int j = i + 1; j < N; ++j) x[i] -= unit_(j, i) * x[j];
  }
  return x;
}

template <int N>
auto Cholesky<N>::invertedUnit() const noexcept -> Matrix {
  Matrix inverse = unit_;
  for (int j = 0; j < N; ++j)
    for (int i = j + 1; i < N; ++i) {
      double sum = inverse(i, j);
      for (int k = j + 1; k < i; ++k) sum += unit_(i, k) * inverse(k, j);
      inverse(i, j) = -sum;
    }
  return inverse;
}

template <int N>
auto Cholesky<N>::inverse() const noexcept -> Matrix {
  const Matrix M = invertedUnit();
  Matrix inverse;
  for (int j = 0; j < N; ++j)
    for (int i = 0; i <= j; ++i) {
      double sum = (i == j ? 1 : M(j, i)) * inverse_pivot_[j];
      for (int k = j + 1; k < N; ++k) sum += M(k, i) * M(k, j) * inverse_pivot_[k];
      inverse(i, j) = inverse(j, i) = sum;
    }
  return inverse;
}

template <int N>
auto Cholesky<N>::inverseTransposed() const noexcept -> Matrix {
  const Matrix M = invertedUnit();
  Matrix inverse = Matrix::Zero();
  for (int j = 0; j < N; ++j) {
    const double inverse_root = std::sqrt(inverse_pivot_[j]);
    inverse(j, j) = inverse_root;
    for (int i = 0; i < j; ++i) inverse(i, j) = M(j, i) * inverse_root;
  }
  return inverse;
}

template class Cholesky<3>;
template class Cholesky<6>;

}  // namespace ambient
