#include "bullet_ambient/spatial/inertia.h"

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

Matrix3 crossMatrix(const Vector3& d) {
  Matrix3 m;
  m << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  return m;
}

Matrix6 shiftOrigin(const Matrix6& inertia, const Vector3& d) {
  // Blocks: [d]x^T X has the columns of X times d; column j of X [d]x is x_k d_l - x_l d_k with
  // j, k, l in cyclic order.
  Matrix6 K = inertia;
  const Eigen::Matrix<double, 6, 3, Eigen::DontAlign> X = inertia.rightCols<3>();
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    const Vector6 turned = X.col(k) * d[l] - X.col(l) * d[k];
    K.col(3 + j).head<3>() += X.col(j).tail<3>().cross(d);
    K.col(j).tail<3>() += turned.tail<3>();
    const Vector3 below = K.col(j).tail<3>();
    K.col(j).head<3>() += turned.head<3>() + below.cross(d);
  }
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
