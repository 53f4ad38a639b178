#pragma once

#include "bullet_ambient/motion/row_velocity.h"

namespace ambient {

/// How freely a body may change its velocity along and about the axes of the world: 1 free, 0
/// locked, anything between as Bullet scales impulses.
struct AxisFactors {
  Vector3 angular = Vector3::Ones();
  Vector3 linear = Vector3::Ones();

  bool areFree() const { return angular == Vector3::Ones() && linear == Vector3::Ones(); }
};

/// K (6x6, SPD, world axes) with rows and columns of locked axes replaced by those of the identity:
/// SPD, and what its inverse holds in the free axes is (P K P)^+, docs/theory.md eq. (30).
Matrix6 freeInertia(const Matrix6& inertia_W, const AxisFactors& factors);

/// K_eff^-1 = F (P K P)^+ F in world axes, docs/theory.md eq. (30), with F the factors and P the
/// projection on the axes that are not locked; symmetric positive semi-definite.
Matrix6 lockedInverse(const Matrix6& inertia_W, const AxisFactors& factors);

/// As computeRowVelocity(), for a body with locked axes: the velocity along them stays. With the
/// whole of the turning part, by the implicit midpoint rule, so that it also serves a body that no
/// row touches; none of it beyond an extent of 1.
RowVelocity computeLockedVelocity(const FlightTask& task, const RigidState& start,
                                  const AxisFactors& factors) noexcept;

}  // namespace ambient
