#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_task.h"

AMBIENT_BEGIN

// A tree with rows that do not turn with it (none, or of its own joints) flies first. Its rows work
// on the velocity u_1 at the end of the flight, with the inertia of its middle, and
//
//   u_m + d/2   is what Bullet moves it by,   u_1 + d   its velocity afterwards
//
//   u_m   mean velocity of the flight;  d  what the rows have changed
//
// but for the base's, which keeps the momentum of the flight: docs/theory.md section 14, rows.
//
// One with contacts or joints to other bodies has rows against x + X, at the pose of the start, and
//
//   xi = x + X + d   is what Bullet moves it by,   x + d + t(q_m, xi)   its velocity afterwards
//
//   x     u_0 after forces and loads;  X  share of the turning part t in it, docs/theory.md eq.
//   (28) q_m   middle of the way
//
// as eq. (31) does it with bodies. Its energy stays within (31a), whatever the turn: more than that
// only if turns in the steps before have lost as much.

/// Before the rows: gives it the velocity that they are solved against. False if that is left to
/// meetAsBodies(). @pre its velocity before the substep is kept in `step`
bool meetTree(AmbientTree& tree, const TreeTask& task) noexcept;

/// Gives up to kFlightsTogether trees without joints, which meetTree() has left, the velocity of
/// their flight, side by side.
void meetAsBodies(AmbientTree* const* trees, int count, const TreeTask& task) noexcept;

/// After them: the velocity by which Bullet is to move it.
void finishTree(AmbientTree& tree, const TreeTask& task) noexcept;

/// After Bullet has moved it: the velocity with which the substep ends. Adds to what it is then, so
/// that impulses that others have given survive.
void completeTree(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
