#include "bullet_ambient/bullet/core/velocity_basis.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"

AMBIENT_BEGIN
namespace {

WorldBasis toBulletBasis(const Matrix6& T) {
  return {toBulletMatrix(T.topLeftCorner<3, 3>()), toBulletMatrix(T.topRightCorner<3, 3>()),
          toBulletMatrix(T.bottomRightCorner<3, 3>())};
}

}  // namespace

WorldBasis toWorld(const Matrix6& basis_B, const Matrix3& R) {
  AMBIENT_ASSERT(isRotation(R));
  AMBIENT_ASSERT(basis_B.allFinite());
  const Matrix3 angular = R * basis_B.topLeftCorner<3, 3>() * R.transpose();
  const Matrix3 coupling = R * basis_B.topRightCorner<3, 3>() * R.transpose();
  const Matrix3 linear = R * basis_B.bottomRightCorner<3, 3>() * R.transpose();
  return {toBulletMatrix(angular), toBulletMatrix(coupling), toBulletMatrix(linear)};
}

WorldBasis toWorld(const Vector6& basis_B, const Matrix3& R) {
  AMBIENT_ASSERT(isRotation(R) && basis_B.minCoeff() > 0);
  const Matrix3 angular = R * basis_B.head<3>().asDiagonal() * R.transpose();
  const Matrix3 linear = R * basis_B.tail<3>().asDiagonal() * R.transpose();
  WorldBasis T;
  T.angular = toBulletMatrix(angular);
  T.linear = toBulletMatrix(linear);
  return T;
}

Matrix3 rootInertia(const Vector3& inertia_diagonal, const Matrix3& R) {
  AMBIENT_ASSERT(inertia_diagonal.minCoeff() > 0 && isRotation(R));
  return R * inertia_diagonal.cwiseSqrt().asDiagonal() * R.transpose();
}

WorldBasis makeLockedBasis(const Matrix6& inertia, double mass, const Matrix3& root_inertia_W,
                           const Matrix3& R, const AxisFactors& factors) {
  const Matrix6 K_W = rotateAxes(inertia, R);
  Matrix6 root = Cholesky<6>(freeInertia(K_W, factors)).inverseTransposed();
  // Rows scaled by the factors; columns of locked axes must not move the body.
  const Vector6 scale = stack(factors.angular, factors.linear);
  for (int axis = 0; axis < 6; ++axis) {
    if (scale[axis] == 0) root.col(axis).setZero();
    root.row(axis) *= scale[axis];
  }
  root.leftCols<3>() = (root.leftCols<3>() * root_inertia_W).eval();
  root.rightCols<3>() *= std::sqrt(mass);
  return toBulletBasis(root);
}

AMBIENT_END
