#include "bullet_ambient/motion/body/even_response.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

double largestEigenvalue(const Eigen::Matrix3d& symmetric) {
  return symmetricEigen(symmetric).values[2];
}

}  // namespace

Vector6 EvenResponse::beyond(const Vector6& momentum, const Vector6& change) const {
  constexpr double kRounding = 1e-12;
  const Vector6 even = *this * momentum;
  Vector6 excess = even - change;
  if (excess.head<3>().norm() <= kRounding * even.head<3>().norm()) excess.head<3>().setZero();
  if (excess.tail<3>().norm() <= kRounding * even.tail<3>().norm()) excess.tail<3>().setZero();
  return excess;
}

EvenResponse makeEvenResponse(const Matrix6& inverse_inertia, const Matrix3& dry_inertia) {
  const Cholesky<3> root(dry_inertia);
  AMBIENT_ASSERT(root.isPositive());
  const Matrix3 L = root.lower();
  const Eigen::Matrix3d angular = L.transpose() * inverse_inertia.topLeftCorner<3, 3>() * L;
  const Eigen::Matrix3d linear = inverse_inertia.bottomRightCorner<3, 3>();
  return {largestEigenvalue(angular) * root.inverse(), largestEigenvalue(linear)};
}

}  // namespace ambient
