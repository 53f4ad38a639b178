#pragma once

#include "bullet_ambient/spatial/frame_offset.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Symmetric 6x6 inertia by its blocks, rotation first: (rotation, coupling; coupling^T,
/// translation). For the step: a change of frame costs a third of that of the whole matrix.
struct LinkInertia {
  Matrix3 rotation, coupling, translation;

  static LinkInertia ofBody(double mass, const Vector3& moments) {
    LinkInertia K{Matrix3::Zero(), Matrix3::Zero(), Matrix3::Zero()};
    K.rotation.diagonal() = moments;
    K.translation.diagonal().setConstant(mass);
    return K;
  }
  static LinkInertia fromMatrix(const Matrix6& K) {
    return {K.topLeftCorner<3, 3>(), K.topRightCorner<3, 3>(), K.bottomRightCorner<3, 3>()};
  }
  Matrix6 matrix() const {
    Matrix6 K;
    K.topLeftCorner<3, 3>() = rotation;
    K.topRightCorner<3, 3>() = coupling;
    K.bottomLeftCorner<3, 3>() = coupling.transpose();
    K.bottomRightCorner<3, 3>() = translation;
    return K;
  }

  LinkInertia& operator+=(const LinkInertia& other) {
    rotation += other.rotation;
    coupling += other.coupling;
    translation += other.translation;
    return *this;
  }
  friend LinkInertia operator*(double s, const LinkInertia& K) {
    return {s * K.rotation, s * K.coupling, s * K.translation};
  }

  Momentum momentum(const Twist& x) const {
    return {rotation * x.angular + coupling * x.linear,
            coupling.transpose() * x.angular + translation * x.linear};
  }
  /// Returns the wrench that gives an acceleration.
  Wrench wrench(const Twist& a) const {
    const Momentum m = momentum(a);
    return {m.angular, m.linear};
  }
  /// K - f g^T, of the parts of a symmetric sum.
  void subtractProduct(const Wrench& f, const Wrench& g) {
    rotation -= f.torque * g.torque.transpose();
    coupling -= f.torque * g.force.transpose();
    translation -= f.force * g.force.transpose();
  }

  /// About B's origin in B's axes, given about F's origin in F's axes: eq. (4), (5) of
  /// docs/theory.md, by blocks.
  LinkInertia toB(const FrameOffset& F) const {
    const Matrix3& R = F.rotation;
    const Matrix3 M = turned(translation, R);
    const Matrix3 T = R * coupling;
    const Matrix3 C = T * R.transpose();
    const Matrix3 C_B = C + crossColumns(F.translation, M);
    // A - C [t] + [t] C_B^T, of which the first two terms are symmetric with the half of the third.
    Matrix3 A = turned(rotation, R);
    for (int i = 0; i < 3; ++i) {
      const Vector3 a = F.translation.cross(C.row(i)), b = F.translation.cross(C_B.row(i));
      for (int j = 0; j < 3; ++j) {
        A(i, j) += a[j];
        A(j, i) += b[j];
      }
    }
    return {A, C_B, M};
  }

 private:
  // R S R^T of a symmetric S.
  static Matrix3 turned(const Matrix3& S, const Matrix3& R) {
    const Matrix3 T = R * S;
    Matrix3 result;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j)
        result(i, j) = result(j, i) = T(i, 0) * R(j, 0) + T(i, 1) * R(j, 1) + T(i, 2) * R(j, 2);
    return result;
  }
  // [t]x M
  static Matrix3 crossColumns(const Vector3& t, const Matrix3& M) {
    Matrix3 product;
    for (int j = 0; j < 3; ++j) product.col(j) = t.cross(M.col(j));
    return product;
  }
};

}  // namespace ambient
