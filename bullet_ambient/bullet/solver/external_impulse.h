#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include "bullet_ambient/bullet/core/conversions.h"

AMBIENT_BEGIN

/// Replaces the velocity change by gravity and applied forces that Bullet has computed for the dry
/// body. Bullet adds it when it writes velocities back. World axes, [rad/s] and [m/s].
inline void setExternalImpulse(btSolverBody& solver_body, const Twist& change_W) {
  solver_body.m_externalTorqueImpulse = toBullet(change_W.angular);
  solver_body.m_externalForceImpulse = toBullet(change_W.linear);
}

AMBIENT_END
