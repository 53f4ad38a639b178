#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_task.h"

AMBIENT_BEGIN

// Energy of a tree at a water surface, docs/theory.md eq. (64): that of its motion relative to the
// flow, of weight and water, and of the waves that its links have made.

/// Whether a surface is near a link.
bool isAtSurface(const AmbientTree& tree) noexcept;

/// Calls visit(AmbientBody&, index in the tree) for links that a surface is near.
template <class Visit>
void forEachAtSurface(const AmbientTree& tree, const Visit& visit) {
  for (const auto& link : tree.links)
    if (tree.tree.links[link->link + 1].model && link->ambient.surface())
      visit(link->ambient, link->link + 1);
}

/// Before a step: keeps the energy of `step.surface.start`, if nothing but weight and water can
/// change it. @pre the dynamics are at the pose, without stiffness
void keepEnergy(AmbientTree& tree) noexcept;

/// Docs/theory.md eq. (81b): whether a flight with the mean velocity `step.moved` that ended with
/// `step.end` may have come to where the energy of place is more than all energy before: false if
/// the motion has more than the buoyancy can err by on its way. Cost: O(links).
bool mayGainEnergy(AmbientTree& tree, double duration) noexcept;

/// Whether it has come there: at a pose of the dynamics, a time since the step began [s].
bool hasGainedEnergy(const AmbientTree& tree, double since_start) noexcept;

/// Scales `step.end`, after the tree has arrived, to the energy before the step of `duration` [s].
/// Returns the energy removed [J].
double boundEnergy(AmbientTree& tree, double duration) noexcept;

AMBIENT_END
