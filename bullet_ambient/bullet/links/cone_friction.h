#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <LinearMath/btAlignedObjectArray.h>

#include "bullet_ambient/bullet/core/precision_check.h"

struct btMultiBodyJacobianData;
struct btMultiBodySolverConstraint;

AMBIENT_BEGIN

/// The two friction rows of a contact of a multibody, and what their solution reads and writes.
struct FrictionPair {
  const btMultiBodySolverConstraint& first;
  const btMultiBodySolverConstraint& second;
  btMultiBodyJacobianData& data;
  btAlignedObjectArray<btSolverBody>& solver_bodies;
};

/// Solves two friction rows together, their impulse within the circle of their limits, like
/// btMultiBodyConstraintSolver::resolveConeFrictionConstraintRows(), but without the C library's
/// arc tangent, sine and cosine. Returns the sum of the velocities along the rows that the impulses
/// change [m/s].
btScalar solveFrictionPair(const FrictionPair& pair) noexcept;

AMBIENT_END
