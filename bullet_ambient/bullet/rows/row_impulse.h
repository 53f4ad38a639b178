#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include "bullet_ambient/bullet/core/four_numbers.h"
#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

/// Applies an impulse to a body like btSolverBody::internalApplyImpulse, with the same bits.
/// `linear`: linear part of the row's Jacobian; `spin`: spin change by a unit impulse.
AMBIENT_INLINE void applyImpulse(btSolverBody& body, const btVector3& linear, const btVector3& spin,
                                 btScalar impulse) noexcept {
  if (!body.m_originalBody) return;
  const Four change = impulse * (load(linear) * load(body.m_invMass));
  store(body.m_deltaLinearVelocity,
        load(body.m_deltaLinearVelocity) + change * load(body.m_linearFactor));
  store(body.m_deltaAngularVelocity,
        load(body.m_deltaAngularVelocity) + load(spin) * (impulse * load(body.m_angularFactor)));
}

AMBIENT_END
