#include "bullet_ambient/motion/even_response.h"

#include <Eigen/Cholesky>

#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

using DenseMatrix3 = Eigen::Matrix<double, 3, 3>;

double largestEigenvalue(const DenseMatrix3& symmetric) {
  return symmetricEigen(symmetric).values[2];
}

}  // namespace

EvenResponse makeEvenResponse(const Matrix6& inverse_inertia, const Matrix3& dry_inertia) {
  const Eigen::LLT<DenseMatrix3> root(dry_inertia);
  const DenseMatrix3 L = root.matrixL();
  const DenseMatrix3 angular = L.transpose() * inverse_inertia.topLeftCorner<3, 3>() * L;
  const DenseMatrix3 linear = inverse_inertia.bottomRightCorner<3, 3>();
  return {largestEigenvalue(angular) * root.solve(DenseMatrix3::Identity()),
          largestEigenvalue(linear)};
}

}  // namespace ambient
