#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

/// The joint that a row of the pool of joints belongs to.
inline const btTypedConstraint* jointOf(const btSolverConstraint& row) {
  return static_cast<const btTypedConstraint*>(row.m_originalContactPoint);
}

/// Whether a joint's row is a limit, a motor or a spring: bounds other than the impulse that breaks
/// the joint.
inline bool hasBounds(const btSolverConstraint& row) {
  const btScalar most = jointOf(row)->getBreakingImpulseThreshold();
  return row.m_lowerLimit > -most || row.m_upperLimit < most;
}

AMBIENT_END
