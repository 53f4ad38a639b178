#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

/// Returns the joint of a row in the pool of joint rows.
inline const btTypedConstraint* jointOf(const btSolverConstraint& row) {
  return static_cast<const btTypedConstraint*>(row.m_originalContactPoint);
}

/// True if the impulse of a joint row has other bounds than the joint's breaking impulse: the row
/// is a limit, a motor or a spring.
inline bool hasBounds(const btSolverConstraint& row) {
  const btScalar most = jointOf(row)->getBreakingImpulseThreshold();
  return row.m_lowerLimit > -most || row.m_upperLimit < most;
}

AMBIENT_END
