#pragma once

#include <cmath>

#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

// Conditions of asserts. Numbers that are not finite pass: a state may have them until its step is
// refused at the end.

/// True if a square matrix is symmetric, up to `rounding` times its largest entry.
template <class Matrix>
bool isSymmetric(const Eigen::MatrixBase<Matrix>& m, double rounding = 0) {
  return !((m - m.transpose()).cwiseAbs().maxCoeff() > rounding * m.cwiseAbs().maxCoeff());
}

/// True if a vector has length 1.
inline bool isUnit(const Vector3& v) { return !(std::abs(v.squaredNorm() - 1) > 1e-5); }

/// True if a matrix is a rotation: it neither scales nor mirrors.
inline bool isRotation(const Matrix3& R) {
  return isUnit(R.col(0)) && isUnit(R.col(1)) && isUnit(R.col(2)) &&
         !((R.col(0).cross(R.col(1)) - R.col(2)).cwiseAbs().maxCoeff() > 1e-5);
}

/// 3x3 matrix [d]x with [d]x a = d x a.
Matrix3 crossMatrix(const Vector3& d);

/// Converts inertia K (6x6, rotation first, symmetric) to the new origin = old origin + d [m]; the
/// axes stay. K' = X^T K X with X = [[I, 0], [[d]x, I]]; docs/theory.md eq. (4).
Matrix6 shiftOrigin(const Matrix6& inertia, const Vector3& d);

/// Converts inertia K to other axes, a' = R a: K' = diag(R, R) K diag(R, R)^T; eq. (5).
Matrix6 rotateAxes(const Matrix6& inertia, const Matrix3& rotation);

/// Inertia per unit density of a shape s times as large: the rotation block grows by s^5, the
/// coupling by s^4, the translation block by s^3; docs/theory.md eq. (5).
Matrix6 scaleShape(const Matrix6& inertia_per_density, double s);

/// Resistance in creeping flow per unit viscosity (6x6, rotation first) of a shape s times as
/// large: the blocks grow by s^3, s^2 and s.
Matrix6 scaleResistance(const Matrix6& resistance_per_viscosity, double s);

/// 6x6 inertia diag(J, m I) of a rigid body about its centre of mass: mass m [kg], rotational
/// inertia J [kg m^2].
Matrix6 rigidBodyInertia(double mass, const Matrix3& rotational_inertia);

}  // namespace ambient
