#pragma once

#include "bullet_ambient/spatial/frame_offset.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

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

/// 6x6 inertia diag(J, m I) of a rigid body about its centre of mass: mass m [kg], rotational
/// inertia J [kg m^2].
Matrix6 rigidBodyInertia(double mass, const Matrix3& rotational_inertia);

}  // namespace ambient
