#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/reading/fluid_reading.h"

AMBIENT_BEGIN

// A rigid body whose wrench is read, in the order of a substep. @pre it has a reading

/// When the solver has met it. With locked axes the impulse of its rows is not known.
void beginBodyReading(AmbientBody& ambient, bool is_locked) noexcept;

/// After the iterations, with their changes of velocity in world axes.
void readRows(AmbientBody& ambient, btSolverBody& solver_body) noexcept;

/// After the action has changed its velocity; `before_W`: that before the action.
void finishBodyReading(AmbientBody& ambient, Outcome kind, const Twist& before_W,
                       double time_step) noexcept;

inline Twist velocityOf(const btRigidBody& body) {
  return {toVector3(body.getAngularVelocity()), toVector3(body.getLinearVelocity())};
}

AMBIENT_END
