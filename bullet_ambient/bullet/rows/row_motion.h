#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"

AMBIENT_BEGIN

// Bullet moves a body with rows by the velocity xi after the rows. Then the body gets the velocity
// of the same momentum P at the new pose, docs/theory.md eq. (31), in a fast turn with twice its
// energy at most E, eq. (31a). Velocities are relative to the flow:
//
//   xi = x + X + d,   P = K(q_n) (x + d),   E = |x + d|^2 + min(0, 2 X.K d)
//
//   x   velocity changed by forces and loads
//   X   part of the turning velocity change in the velocity that rows are solved against, eq. (28)
//   d   velocity change by the rows

// Functions for up to kFlightsTogether bodies side by side; the bits of a body do not depend on the
// others.

/// Returns the velocity change by rows after the iterations, world axes.
inline Twist changeByRows(btSolverBody& b) {
  return {toVector3(b.internalGetDeltaAngularVelocity()),
          toVector3(b.internalGetDeltaLinearVelocity())};
}

/// A body after the iterations; `solver_body`: velocity changes in world axes.
struct SolvedBody {
  AmbientBody* ambient;
  const RowBody* row_body;
  btSolverBody* solver_body;
  double turn_share;  ///< part of the turn by split impulses that Bullet makes
};

/// Stores momentum, energy bound and start in AmbientBody::outcome for endRowMotions(). Makes the
/// turns by split impulses.
void beginRowMotions(const SolvedBody* bodies, int count, double time_step) noexcept;

/// Adds the velocity changes x_(n+1) - xi of eq. (31), in world axes. Call after Bullet has moved
/// the bodies; turns them to the attitudes of their ways. Does nothing for a body that is not on
/// its way from the start along xi, because others have moved it.
void endRowMotions(AmbientBody* const* bodies, int count, double time_step,
                   Complaints& complaints) noexcept;

AMBIENT_END
