#include "bullet_ambient/motion/even_response.h"

#include <Eigen/Cholesky>

#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3>;

double largestEigenvalue(const Matrix& symmetric) { return symmetricEigen(symmetric).values[2]; }

}  // namespace

EvenResponse makeEvenResponse(const Matrix6& inverse_inertia, const Matrix3& dry_inertia) {
  const Eigen::LLT<Matrix> root(dry_inertia);
  const Matrix L = root.matrixL();
  const Matrix angular = L.transpose() * inverse_inertia.topLeftCorner<3, 3>() * L;
  const Matrix linear = inverse_inertia.bottomRightCorner<3, 3>();
  return {largestEigenvalue(angular) * root.solve(Matrix::Identity()), largestEigenvalue(linear)};
}

}  // namespace ambient
