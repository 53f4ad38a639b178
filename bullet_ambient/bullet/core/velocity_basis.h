#pragma once

#include <LinearMath/btMatrix3x3.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/rows/axis_locks.h"

AMBIENT_BEGIN

/// Velocity basis T of docs/theory.md eq. (26) in world axes, in Bullet's precision: u = T u' with
/// u = (w, v). The lower left block is zero.
struct WorldBasis {
  btMatrix3x3 angular = btMatrix3x3::getIdentity();    ///< w from w'
  btMatrix3x3 coupling = {0, 0, 0, 0, 0, 0, 0, 0, 0};  ///< w from v'
  btMatrix3x3 linear = btMatrix3x3::getIdentity();     ///< v from v'
};
WorldBasis toWorld(const Matrix6& basis_B, const Matrix3& rotation_WB);
/// Rotates a diagonal basis into world axes.
WorldBasis toWorld(const Vector6& basis_B, const Matrix3& rotation_WB);

/// T in world axes for a body with locked axes: T D T^T = K_eff^-1 of docs/theory.md eq. (30). T is
/// not constant in body axes, and it is singular: components of u' along locked axes do not move
/// the body. `inertia`: K in B; `mass` of the dry body [kg].
WorldBasis makeLockedBasis(const Matrix6& inertia, double mass, const Matrix3& root_inertia_W,
                           const Matrix3& rotation_WB, const AxisFactors& factors);

/// sqrt(I) in world axes, for principal moments I [kg m^2].
Matrix3 rootInertia(const Vector3& inertia_diagonal, const Matrix3& rotation_WB);

AMBIENT_END
