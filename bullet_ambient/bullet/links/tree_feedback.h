#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_task.h"

AMBIENT_BEGIN

/// True if a link of the multibody has a btMultiBodyJointFeedback.
bool wantsJointForces(const btMultiBody& multi_body) noexcept;

/// Replaces the joint forces in btMultiBodyJointFeedback, which Bullet has computed without fluid,
/// by those in fluid: inverse dynamics of the mean acceleration of the substep, at the pose in its
/// middle. Forces of rows count as applied forces, as in Bullet. Velocity-dependent terms count
/// once; Bullet counts them twice. @pre `step` has the velocities of this substep
void writeJointForces(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
