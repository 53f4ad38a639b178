#include "bullet_ambient/spatial/symmetric_eigen.h"

#include <Eigen/Eigenvalues>

namespace ambient {

template <int N>
SymmetricEigen<N> symmetricEigen(const Eigen::Matrix<double, N, N>& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template SymmetricEigen<3> symmetricEigen(const Eigen::Matrix<double, 3, 3>&);
template SymmetricEigen<6> symmetricEigen(const Eigen::Matrix<double, 6, 6>&);

}  // namespace ambient
