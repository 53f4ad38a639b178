#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

// Bullet's functions that solve one row, by four numbers side by side, where its build on this
// system takes one number after the other. Each sum is added up in Bullet's order, so that
// impulses, velocities and residuals have the same bits.
//
//   ds = rhs - c s - j (J_1 du_1 + J_2 du_2),   s' = clamp(s + ds),   du_i += D_i J_i^T (s' - s)
//
//   s  impulse of the row;  rhs, c, j  its right-hand side, softness, inverse effective mass
//   J_i, D_i, du_i  of the two bodies: Jacobian, inverse inertia, change of velocity

/// Rows of a pool in the order in which an iteration takes them.
struct RowPass {
  const btConstraintArray& rows;
  const btAlignedObjectArray<int>& order;
  btAlignedObjectArray<btSolverBody>& bodies;
};

/// Functions that solve rows. Their residual is a velocity [m/s].
struct QuickRows {
  btSingleConstraintRowSolver generic;      ///< between two limits; returns its residual
  btSingleConstraintRowSolver lower_limit;  ///< above one limit: a contact; returns its residual
  /// Contacts in turn. Returns the largest square of residuals, at least `largest`.
  btScalar (*contacts)(const RowPass& pass, btScalar largest);
  /// Frictions of contacts that push, within what these allow. Returns as contacts().
  btScalar (*frictions)(const RowPass& pass, const btConstraintArray& contacts, btScalar largest);
};

/// Returns the row functions for the processor's instruction set.
const QuickRows& quickRows() noexcept;

AMBIENT_END
