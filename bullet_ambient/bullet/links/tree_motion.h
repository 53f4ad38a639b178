#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_links.h"

AMBIENT_BEGIN

// Motion of a tree in a substep, docs/theory.md section 14, "Rows".
//
// A tree without rows, or with rows of its own joints alone, flies first. The rows are solved
// against the velocity u_1 at the end of the flight, with H in the middle of the flight. Bullet
// moves the tree by
//
//   u_m + d/2, and the velocity becomes u_1 + d
//
//   u_m   mean velocity of the flight
//   d     velocity change by the rows
//
// The velocity of the base is then corrected, so that the tree keeps the momentum of the flight.
//
// For a tree with contacts or joints to other bodies, rows are solved against x + X at the start
// pose, as for bodies, eq. (28). Bullet moves the tree by
//
//   xi = x + X + d, and the velocity becomes x + d + t(q_m, xi)
//
//   x     start velocity changed by forces and loads
//   t     turning part of eq. (28): velocity change by gyroscopic terms;  X  included share of it
//   q_m   pose in the middle of the step
//
// The energy stays within the bound of eq. (31a). Energy that this bound has left unused in earlier
// steps (`reserve`) may be used later.

/// Call before Bullet makes rows. Sets the velocity of a tree to the one that rows are solved
/// against. Returns false, and sets none, for a tree that flies as a body: call flyLoneTrees() for
/// it. @pre `step.start` is the velocity before the substep
bool prepareTree(AmbientTree& tree, const TreeTask& task) noexcept;

/// Flies up to kFlightsTogether trees for which prepareTree() was false, side by side, and sets
/// their velocities to those at the end of the flights.
void flyLoneTrees(AmbientTree* const* trees, int count, const TreeTask& task) noexcept;

/// Call after the rows are solved. Sets the velocity that Bullet moves the tree by.
void finishTree(AmbientTree& tree, const TreeTask& task) noexcept;

/// Call after Bullet has moved the tree. Adds the difference between the velocity at the end of the
/// substep and the one that Bullet has moved it by, so that impulses which others have applied
/// meanwhile survive.
void completeTree(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
