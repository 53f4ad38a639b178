#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/reading/fluid_reading.h"

AMBIENT_BEGIN

// Functions for a rigid body whose wrench is read, in the order of calls in a substep. @pre
// AmbientBody::reading is set

/// Begins the substep once the solver has met the body. With locked axes the impulse of its rows is
/// not known.
void beginBodyReading(AmbientBody& ambient, bool is_locked) noexcept;

/// Reads the impulse of rows from their velocity changes (world axes), after the solver's
/// iterations.
void readRows(AmbientBody& ambient, btSolverBody& solver_body, double time_step) noexcept;

/// Computes the wrenches after the action has set the velocity; `before_W`: velocity before the
/// action.
void finishBodyReading(AmbientBody& ambient, Outcome kind, const Twist& before_W,
                       double time_step) noexcept;

AMBIENT_END
