#include "bullet_ambient/spatial/principal_frame.h"

#include <Eigen/Eigenvalues>

namespace ambient {

PrincipalFrame findPrincipalFrame(const Matrix3& inertia) {
  // Meshes that are mirror-symmetric have products of inertia of rounding size.
  constexpr double kRounding = 1e-12;
  const Matrix3 diagonal = inertia.diagonal().asDiagonal();
  if ((inertia - diagonal).cwiseAbs().maxCoeff() <= kRounding * inertia.trace())
    return {inertia.diagonal(), Matrix3::Identity()};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(inertia);
  Matrix3 rotation = eigen.eigenvectors();
  if (rotation.determinant() < 0) rotation.col(2) *= -1;
  return {eigen.eigenvalues(), rotation};
}

}  // namespace ambient
