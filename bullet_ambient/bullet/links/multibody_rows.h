#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>
#include <LinearMath/btAlignedObjectArray.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

AMBIENT_BEGIN

/// Rewrites rows of multibodies that touch an ambient body or a tree in fluid, and rescales their
/// effective masses, right-hand sides and softness. The side of an ambient body is brought into its
/// velocity basis, J' = J T, docs/theory.md eq. (27). Bullet computes its velocity in these rows
/// with the dry body's forces, or without forces: the difference to k + X of eq. (28) is added. The
/// side of a tree keeps J and gets the response H^-1 J^T, docs/theory.md section 14; TreeGroup has
/// set its velocity before Bullet made the rows.
void rewriteMultiBodyRows(const MultiBodyRows& rows, const btContactSolverInfo& info,
                          RowBodies& bodies,
                          const btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

/// Calls visit(solver body id) for the rigid sides of rows that join multibodies to rigid bodies.
/// These bodies are known only once Bullet has made the rows.
template <class Visit>
void forEachJoinedBody(const btMultiBodyConstraintArray& joints, const Visit& visit) {
  for (int i = 0; i < joints.size(); ++i)
    for (const int id : {rigidBodyA(joints[i]), rigidBodyB(joints[i])})
      if (id >= 0) visit(id);
}

/// Solves the two friction rows of a contact of a multibody together, their impulse within the
/// circle of their limits, like btMultiBodyConstraintSolver::resolveConeFrictionConstraintRows(),
/// but without the C library's arc tangent, sine and cosine. Returns the sum of the velocities
/// along the rows that the impulses change [m/s].
btScalar solveFrictionPair(const btMultiBodySolverConstraint& first,
                           const btMultiBodySolverConstraint& second, btMultiBodyJacobianData& data,
                           btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

AMBIENT_END
