#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_links.h"

AMBIENT_BEGIN

/// True if a water surface is near a link.
bool isAtSurface(const AmbientTree& tree) noexcept;

/// Calls visit(AmbientLink&, index in the tree) for links near a water surface.
template <class Visit>
void forEachAtSurface(const AmbientTree& tree, const Visit& visit) {
  for (const auto& link : tree.links)
    if (tree.tree.links[link->link + 1].model && link->ambient.surface())
      visit(*link, link->link + 1);
}

// A water surface acts on links as on bodies that rows move: waves and wind at the start of a step,
// change of added mass at its end. Each link alone would change its twist V_l = J_l u to y_l. The
// tree takes the motion that is nearest to these twists in the norm of the K_l:
//
//   u' = H^-1 sum over links J_l^T K_l y_l                        docs/theory.md eq. (81a)
//
//   K_l  total inertia of a link;  H = sum over links J_l^T K_l J_l
//
// It has no more energy than the links would have alone, the sum of y_l.K_l y_l / 2.

/// Call before a step. Changes `step.start` by the water that has come into holds of links. @pre
/// prepareLinks()
void takeInflow(AmbientTree& tree) noexcept;

/// Call before a step, or before each part of a step that is flown in parts. Changes `step.start`
/// by the waves that links make and by the wind. @pre prepareLinks()
void kickAtSurface(AmbientTree& tree, const TreeTask& task) noexcept;

/// Call before rows that turn with the tree are prepared. Stiffens the inertia of links whose
/// floating period is too short for the step, docs/theory.md eq. (68). @pre kickAtSurface()
void stiffenForRows(AmbientTree& tree) noexcept;

/// Call before a flight. Gives the links the buoyancy of where `step.start` brings them to in half
/// the time, and stiffens them by their waterplanes if their floating period is too short for the
/// step; docs/theory.md section 14. @pre kickAtSurface()
void floatInMiddle(AmbientTree& tree) noexcept;

/// Changes `step.end` by the change of added mass on the way from the pose of kickAtSurface() to
/// `step.pose`, and removes energy above the work of weight and buoyancy, docs/theory.md eq. (66),
/// (68a). Returns the energy removed [J].
double arriveAtSurface(AmbientTree& tree) noexcept;

// Energy of a tree at a water surface, docs/theory.md eq. (64): kinetic energy relative to the
// flow, potential energy of weight and water, and energy of the waves that its links have made.

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

/// Call after Bullet has moved the tree. Calls arriveAtSurface() at the present pose. If no rows
/// have moved the tree, scales the motion relative to the flow so that the energy does not exceed
/// the one that keepEnergy() stored.
void passSurface(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
