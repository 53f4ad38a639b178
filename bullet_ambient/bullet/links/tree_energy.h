#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_links.h"

AMBIENT_BEGIN

// Energy of a tree at a water surface, docs/theory.md eq. (64): kinetic energy relative to the
// flow, potential energy of weight and water, and energy of the waves that its links have made.

/// True if a water surface is near a link.
bool isAtSurface(const AmbientTree& tree) noexcept;

/// Calls visit(AmbientLink&, index in the tree) for links near a water surface.
template <class Visit>
void forEachAtSurface(const AmbientTree& tree, const Visit& visit) {
  for (const auto& link : tree.links)
    if (tree.tree.links[link->link + 1].model && link->ambient.surface())
      visit(*link, link->link + 1);
}

/// Call before a step. Stores the energy of the tree with the velocity `step.surface.start`. If
/// wind, applied torques or joint forces act, stores that there is no bound. @pre the dynamics are
/// at the pose, with inertias that are not stiffened
void keepEnergy(AmbientTree& tree) noexcept;

/// Returns false if a flight with mean velocity `step.moved` and end velocity `step.end` cannot
/// have reached a pose with more potential energy than the stored energy: the kinetic energy at the
/// end exceeds the largest error of the work of buoyancy, docs/theory.md eq. (81b). `duration` [s].
/// Cost: O(links).
bool mayGainEnergy(AmbientTree& tree, double duration) noexcept;

/// True if the potential energy at the pose of the dynamics exceeds the stored energy, a time
/// `since_start` [s] after the start of the step.
bool hasGainedEnergy(const AmbientTree& tree, double since_start) noexcept;

/// Scales `step.end` relative to the flow, so that the energy does not exceed the one that
/// keepEnergy() stored. `duration` of the step [s]. Returns the energy removed [J]. @pre
/// arriveAtSurface()
double boundEnergy(AmbientTree& tree, double duration) noexcept;

AMBIENT_END
