#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

// Bullet's functions that solve one row, with four numbers per instruction. Bullet's build on Linux
// computes one number after another. Sums are added in Bullet's order, so that impulses, velocities
// and residuals have the same bits.
//
//   ds = rhs - c s - j (J_1 du_1 + J_2 du_2),   s' = clamp(s + ds),   du_i += D_i J_i^T (s' - s)
//
//   s  impulse of the row;  rhs, c, j  its right-hand side, softness, inverse effective mass
//   J_i, D_i, du_i  Jacobian, inverse inertia and velocity change of the two bodies

/// Rows of a pool in the order in which an iteration takes them.
struct RowPass {
  const btConstraintArray& rows;
  const btAlignedObjectArray<int>& order;
  btAlignedObjectArray<btSolverBody>& bodies;
};

/// Functions that solve rows. A residual is the velocity along a row that its impulse changes
/// [m/s].
struct QuickRows {
  /// Solves a row between a lower and an upper limit. Returns its residual.
  btSingleConstraintRowSolver generic;
  /// Solves a row with a lower limit alone, a contact. Returns its residual.
  btSingleConstraintRowSolver lower_limit;
  /// Solves all contact rows. Returns the largest squared residual, or `largest` if that is larger.
  btScalar (*contacts)(const RowPass& pass, btScalar largest);
  /// Solves the friction rows of contacts whose impulse is positive, between -mu and mu times that
  /// impulse. Returns a value like contacts().
  btScalar (*frictions)(const RowPass& pass, const btConstraintArray& contacts, btScalar largest);
  /// Joints in turn, those that take part in an iteration. Returns as contacts().
  btScalar (*joints)(const RowPass& pass, int iteration, btScalar largest);
};

/// Returns the row functions for the processor's instruction set.
const QuickRows& quickRows() noexcept;

AMBIENT_END
