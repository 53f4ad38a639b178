#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_links.h"

AMBIENT_BEGIN

/// Flies a tree over a substep, from `step.pose` with velocity `step.start`. Writes the mean
/// velocity to `step.moved`, the end velocity to `step.end`, and the outcome. At a water surface, a
/// step that ends with more potential energy than it had energy is flown again in 2, 4, ... parts,
/// and ends early if that does not help; docs/theory.md section 14, eq. (81b). Returns false if a
/// result is not finite.
/// @pre no row turns with the tree; `step.start` contains the kicks by the surface
bool flyTree(AmbientTree& tree, const TreeTask& task) noexcept;

/// True if a tree flies as a free rigid body: it has one link, its base is not fixed, it was awake,
/// and no row turns with it. @pre prepareLinks()
bool fliesAsBody(const AmbientTree& tree) noexcept;

/// Flies up to kFlightsTogether trees for which fliesAsBody() is true, side by side. Calls
/// beginFlights() for their links, so that they have the bits of rigid bodies. Writes what
/// flyTree() does. A flight that is not finite, or turns faster than Bullet can move a multibody,
/// leaves its tree and the outcome unchanged. @pre prepareLinks()
void flyAsBodies(AmbientTree* const* trees, int count, const TreeTask& task) noexcept;

AMBIENT_END
