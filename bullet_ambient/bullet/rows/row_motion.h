#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"

AMBIENT_BEGIN

// A body with rows moves, as in stock Bullet, by the velocity that they have left it, seen from the
// flow
//
//   xi = x + X + d,   P = K(q_n) (x + d),   E = |x + d|^2 + min(0, 2 X.K d)
//
//   x      velocity after forces and loads;  X  share of the turning part, docs/theory.md eq. (28)
//   d      what the rows have changed
//   P, E   momentum that the body keeps, and twice the energy that it may have where it turns far
//
// and then takes the velocity that this momentum has in the new pose, eq. (31).

/// After the iterations, with their changes of velocity in world axes: keeps what endRowMotion()
/// needs.
void beginRowMotion(AmbientBody& ambient, const RowBody& row_body, btSolverBody& solver_body,
                    double time_step) noexcept;

/// After Bullet has moved the body: adds the change of velocity of eq. (31). Does nothing to a body
/// that others have put elsewhere meanwhile.
void endRowMotion(AmbientBody& ambient, double time_step, Complaints& complaints) noexcept;

AMBIENT_END
