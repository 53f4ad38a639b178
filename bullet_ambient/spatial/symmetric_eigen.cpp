#include "bullet_ambient/spatial/symmetric_eigen.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

template <int N>
SymmetricEigen<N> symmetricEigen(const Eigen::Matrix<double, N, N>& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template SymmetricEigen<3> symmetricEigen(const Eigen::Matrix<double, 3, 3>&);
template SymmetricEigen<6> symmetricEigen(const Eigen::Matrix<double, 6, 6>&);

PrincipalFrame findPrincipalFrame(const Matrix3& inertia) {
  AMBIENT_ASSERT(inertia.allFinite() && isSymmetric(inertia, 1e-9));
  // Meshes that are mirror-symmetric have products of inertia of rounding size.
  constexpr double kRounding = 1e-12;
  const Matrix3 diagonal = inertia.diagonal().asDiagonal();
  if ((inertia - diagonal).cwiseAbs().maxCoeff() <= kRounding * inertia.trace())
    return {inertia.diagonal(), Matrix3::Identity()};
  const SymmetricEigen<3> eigen = symmetricEigen<3>(inertia);
  Matrix3 rotation = eigen.vectors;
  if (rotation.determinant() < 0) rotation.col(2) *= -1;
  return {eigen.values, rotation};
}

}  // namespace ambient
