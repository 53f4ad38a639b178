#include "bullet_ambient/spatial/inertia.h"

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

Matrix3 crossMatrix(const Vector3& d) {
  Matrix3 m;
  m << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  return m;
}

namespace {

// Returns [d]x^T M: columns of M times d. Eigen's colwise().cross() takes twice the instructions.
Matrix3 crossColumns(const Matrix3& M, const Vector3& d) {
  Matrix3 product;
  for (int i = 0; i < 3; ++i) product.col(i) = M.col(i).cross(d);
  return product;
}

}  // namespace

Matrix6 shiftOrigin(const Matrix6& inertia, const Vector3& d) {
  // By blocks; M [d]x is the transpose of [d]x^T M^T.
  Matrix6 K = inertia;
  const Matrix3 M = K.bottomRightCorner<3, 3>(), C = K.topRightCorner<3, 3>();
  K.topRightCorner<3, 3>() += crossColumns(M, d);
  K.bottomLeftCorner<3, 3>() += crossColumns(M.transpose(), d).transpose();
  const Matrix3 below = K.bottomLeftCorner<3, 3>();
  K.topLeftCorner<3, 3>() += crossColumns(C.transpose(), d).transpose() + crossColumns(below, d);
  return K;
}

Matrix6 rotateAxes(const Matrix6& inertia, const Matrix3& rotation) {
  AMBIENT_ASSERT(isRotation(rotation));
  Matrix6 B = Matrix6::Zero();
  B.topLeftCorner<3, 3>() = rotation;
  B.bottomRightCorner<3, 3>() = rotation;
  return B * inertia * B.transpose();
}

Matrix6 scaleShape(const Matrix6& inertia_per_density, double s) {
  AMBIENT_ASSERT(s > 0);
  Vector6 powers;
  powers << s, s, s, 1, 1, 1;
  return s * s * s * (powers.asDiagonal() * inertia_per_density * powers.asDiagonal());
}

Matrix6 scaleResistance(const Matrix6& resistance_per_viscosity, double s) {
  Vector6 units;
  units << s, s, s, 1, 1, 1;
  return s * (units.asDiagonal() * resistance_per_viscosity * units.asDiagonal());
}

Matrix6 rigidBodyInertia(double mass, const Matrix3& rotational_inertia) {
  Matrix6 K = Matrix6::Zero();
  K.topLeftCorner<3, 3>() = rotational_inertia;
  K.bottomRightCorner<3, 3>().diagonal().setConstant(mass);
  return K;
}

Matrix6 FrameOffset::inertiaToB(const Matrix6& inertia_F) const {
  // The vector from F's origin to B's origin, in B's axes, is -translation.
  return shiftOrigin(rotateAxes(inertia_F, rotation), -translation);
}

}  // namespace ambient
