#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_task.h"

AMBIENT_BEGIN

// A water surface kicks links as it kicks bodies that rows move. Each link alone would change its
// twist V_l = J_l u to y_l. The tree takes the motion that is nearest to all of these:
//
//   u' = H^-1 sum over links J_l^T K_l y_l                        docs/theory.md eq. (81a)
//
//   K_l  total inertia of a link;  H = sum over links J_l^T K_l J_l
//
// It has no more energy than the links would have alone, sum of y_l.K_l y_l / 2.

/// Before a step with or without rows, or a part of one: changes `step.start` by the waves that
/// links make and by the wind, and stiffens links whose swing the step is too long for.
/// @pre prepareLinks()
void kickAtSurface(AmbientTree& tree, const TreeTask& task) noexcept;

/// At `step.pose`, to which the tree has come since kickAtSurface(): changes `step.end` by the
/// change of added mass on the way, and removes the energy that the buoyancy did not have. Returns
/// that energy [J].
double arriveAtSurface(AmbientTree& tree) noexcept;

/// After Bullet has moved the tree: arrives, with no more energy than before the step if no rows
/// have moved it.
void passSurface(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
