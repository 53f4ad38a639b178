#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/links/tree_task.h"

AMBIENT_BEGIN

/// Whether Bullet is asked for the forces in joints of a multibody.
bool wantsJointForces(const btMultiBody& multi_body) noexcept;

/// Replaces the joint forces that Bullet has computed without fluid, btMultiBodyJointFeedback, by
/// those that have made the change of velocity of the substep, at the middle of its way. As with
/// Bullet, rows act as forces from outside; what is due to velocities counts once, and with Bullet
/// twice. @pre `step` has the velocities of this substep
void writeJointForces(AmbientTree& tree, const TreeTask& task) noexcept;

AMBIENT_END
