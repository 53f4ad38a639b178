#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

Matrix3 crossMatrix(const Vector3& d) {
  Matrix3 m;
  m << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
  return m;
}

Matrix6 shiftOrigin(const Matrix6& inertia, const Vector3& d) {
  // Twist at the old origin from the twist at the new one: v_old = v_new + w x (-d) = v_new + d x
  // w.
  Matrix6 X = Matrix6::Identity();
  X.bottomLeftCorner<3, 3>() = crossMatrix(d);
  return X.transpose() * inertia * X;
}

Matrix6 rotateAxes(const Matrix6& inertia, const Matrix3& rotation) {
  Matrix6 B = Matrix6::Zero();
  B.topLeftCorner<3, 3>() = rotation;
  B.bottomRightCorner<3, 3>() = rotation;
  return B * inertia * B.transpose();
}

Matrix6 scaleShape(const Matrix6& inertia_per_density, double s) {
  Vector6 powers;
  powers << s, s, s, 1, 1, 1;
  return s * s * s * (powers.asDiagonal() * inertia_per_density * powers.asDiagonal());
}

Matrix6 rigidBodyInertia(double mass, const Matrix3& rotational_inertia) {
  Matrix6 K = Matrix6::Zero();
  K.topLeftCorner<3, 3>() = rotational_inertia;
  K.bottomRightCorner<3, 3>().diagonal().setConstant(mass);
  return K;
}

Matrix6 FrameOffset::inertiaToB(const Matrix6& inertia_F) const {
  // B's origin seen from F's, in B's axes, is -translation.
  return shiftOrigin(rotateAxes(inertia_F, rotation), -translation);
}

}  // namespace ambient
