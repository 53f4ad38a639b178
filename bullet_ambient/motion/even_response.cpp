#include "bullet_ambient/motion/even_response.h"

#include <Eigen/Cholesky>

#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

double largestEigenvalue(const Eigen::Matrix3d& symmetric) {
  return symmetricEigen(symmetric).values[2];
}

}  // namespace

EvenResponse makeEvenResponse(const Matrix6& inverse_inertia, const Matrix3& dry_inertia) {
  const Eigen::LLT<Eigen::Matrix3d> root(dry_inertia);
  const Eigen::Matrix3d L = root.matrixL();
  const Eigen::Matrix3d angular = L.transpose() * inverse_inertia.topLeftCorner<3, 3>() * L;
  const Eigen::Matrix3d linear = inverse_inertia.bottomRightCorner<3, 3>();
  return {largestEigenvalue(angular) * root.solve(Eigen::Matrix3d::Identity()),
          largestEigenvalue(linear)};
}

}  // namespace ambient
