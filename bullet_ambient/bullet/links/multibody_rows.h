#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_pools.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

AMBIENT_BEGIN

/// Brings the rigid side of all rows that touch an ambient body into its velocity basis, as
/// rewriteRows() does: J' = J T; effective mass, right-hand side and softness rescaled. Bullet lets
/// these rows see applied forces without fluid, or none: they are made to see the change of
/// velocity that the fluid body really has. Trees in fluid keep J, and get the response H^-1 J^T;
/// their velocity is that in the fluid when Bullet makes the rows.
void rewriteMultiBodyRows(const MultiBodyRows& rows, const btContactSolverInfo& info,
                          RowBodies& bodies,
                          const btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

/// Calls visit(solver body id) for the rigid sides of rows that join multibodies to rigid bodies:
/// Bullet does not tell these bodies before the rows are made.
template <class Visit>
void forEachJoinedBody(const btMultiBodyConstraintArray& joints, const Visit& visit) {
  for (int i = 0; i < joints.size(); ++i) {
    if (!joints[i].m_multiBodyA && joints[i].m_solverBodyIdA >= 0) visit(joints[i].m_solverBodyIdA);
    if (!joints[i].m_multiBodyB && joints[i].m_solverBodyIdB >= 0) visit(joints[i].m_solverBodyIdB);
  }
}

/// Applies the impulses that rows begin with to ambient bodies, in their bases.
void reapplyMultiBodyImpulses(const btMultiBodyConstraintArray& rows, RowBodies& bodies,
                              btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

AMBIENT_END
