#pragma once

#include "bullet_ambient/spatial/frame_offset.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// [d]x, the 3x3 matrix with [d]x a = d x a.
Matrix3 crossMatrix(const Vector3& d);

/// Inertia K (6x6, rotation first, symmetric) expressed about a new origin, old origin + d [m]; the
/// axes stay. K' = X^T K X with X = [[I, 0], [[d]x, I]]; docs/theory.md eq. (4).
Matrix6 shiftOrigin(const Matrix6& inertia, const Vector3& d);

/// Inertia K expressed in axes turned by R: K' = diag(R, R) K diag(R, R)^T; docs/theory.md eq. (5).
Matrix6 rotateAxes(const Matrix6& inertia, const Matrix3& rotation);

/// Inertia per unit density of the shape scaled by s: rotation block s^5, coupling s^4, translation
/// s^3.
Matrix6 scaleShape(const Matrix6& inertia_per_density, double s);

/// 6x6 inertia of a rigid body of mass m [kg] and rotational inertia J [kg m^2] about its centre of
/// mass, which is the origin: diag(J, m I).
Matrix6 rigidBodyInertia(double mass, const Matrix3& rotational_inertia);

}  // namespace ambient
