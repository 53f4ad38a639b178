#pragma once

#include "bullet_ambient/motion/rows/row_velocity.h"

namespace ambient {

/// Bullet's factors of impulses along and about the axes of W: 1 free, 0 locked; other
/// values scale the impulse.
struct AxisFactors {
  Vector3 angular = Vector3::Ones();
  Vector3 linear = Vector3::Ones();

  bool areFree() const {
    for (int axis = 0; axis < 3; ++axis)
      if (angular[axis] != 1 || linear[axis] != 1) return false;
    return true;
  }
};

/// K (6x6, SPD, world axes) with rows and columns of locked axes replaced by those of the identity.
/// The result is SPD; its inverse is (P K P)^+ in the free axes, docs/theory.md eq. (30).
Matrix6 freeInertia(const Matrix6& inertia_W, const AxisFactors& factors);

/// K_eff^-1 = F (P K P)^+ F in world axes, docs/theory.md eq. (30), with F the factors and P the
/// projection on the axes that are not locked; symmetric positive semi-definite.
Matrix6 lockedInverse(const Matrix6& inertia_W, const AxisFactors& factors);

/// Returns a change of velocity in W without its parts along and about locked axes.
Twist onFreeAxes(const Twist& change_W, const AxisFactors& factors);

/// Returns what locks leave of a change of velocity that a free body would take, in W: K_eff^-1
/// times its momentum. `inertia`: K in B; R: B to W; change_B: of the free body, in B.
Twist lockedChange(const Matrix6& inertia, const Matrix3& R, const AxisFactors& factors,
                   const Vector6& change_B);

/// Like computeRowVelocity(), for a body with locked axes, along which the velocity stays. Contains
/// the whole turning part t, by the implicit midpoint rule, because such bodies have no free
/// flight; 0 instead of t beyond an extent of 1, with the limits 1 rad and 0.3 in eq. (28a).
RowVelocity computeLockedVelocity(const FlightTask& task, const RigidState& start,
                                  const AxisFactors& factors) noexcept;

}  // namespace ambient
