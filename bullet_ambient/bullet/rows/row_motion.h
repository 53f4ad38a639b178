#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>

#include <optional>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/warnings.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"

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

/// Returns the velocity change by rows after the iterations, world axes.
inline Twist changeByRows(btSolverBody& b) {
  return {toVector3(b.internalGetDeltaAngularVelocity()),
          toVector3(b.internalGetDeltaLinearVelocity())};
}

/// Up to kFlightsTogether ambient bodies of a group that rows may move, from the preparation of
/// their rows to the end of the iterations. The bits of a body do not depend on the others.
struct RowBatch {
  RowLanes lanes;
  int count = 0;
  AmbientBody* bodies[kFlightsTogether] = {};
  int solver_bodies[kFlightsTogether] = {};                  ///< indices in the solver's pool
  Vector3 positions[kFlightsTogether];                       ///< centres of mass at the start [m]
  std::optional<Matrix6> settled_inertia[kFlightsTogether];  ///< of RowVelocity
  Wrench loads_W[kFlightsTogether];                          ///< RowLoad::mean_W
};

/// Stores momentum, energy bound and start of the active bodies in AmbientBody::outcome for
/// endRowMotions(). Makes the turns by split impulses; `turn_share`: the part of them that Bullet
/// makes. `solver_bodies`: with velocity changes in world axes.
void beginRowMotions(RowBatch& batch, RowBodies& row_bodies,
                     btAlignedObjectArray<btSolverBody>& solver_bodies, double turn_share,
                     double time_step) noexcept;

/// Adds the velocity changes x_(n+1) - xi of eq. (31), in world axes. Call after Bullet has moved
/// the bodies; turns them to the attitudes of their ways. Does nothing for a body that is not on
/// its way from the start along xi, because others have moved it. At most kFlightsTogether bodies.
void endRowMotions(AmbientBody* const* bodies, int count, double time_step,
                   Warnings& warnings) noexcept;

AMBIENT_END
