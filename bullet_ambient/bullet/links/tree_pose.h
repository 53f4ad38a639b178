#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_trees.h"

AMBIENT_BEGIN

/// Replaces the turns of a tree that Bullet has moved for the time h [s] by those with our sine and
/// cosine: of its base, its spherical and planar joints, what Bullet keeps of its joints, and its
/// colliders. Leaves a base or joint alone that others have moved. Allocates nothing.
/// @pre Bullet has moved it from `step.pose`, the base from `step.to_base`, by the velocity
/// `step.moved`
void settleTree(AmbientTree& tree, double h) noexcept;

AMBIENT_END
