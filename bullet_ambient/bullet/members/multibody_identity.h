#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"

class btMultiBody;

AMBIENT_BEGIN

// Bullet numbers btRigidBody and not btMultiBody. The number stands where finalizeMultiDof() makes
// room for changes of position, behind velocities and joint inertias. finalizeMultiDof() of a new
// btMultiBody zeroes this room, so that a new one at an old address has no number. Nothing but
// Bullet's RK4 integration reads or writes there.

/// Reads the number that a btMultiBody was given; 0: none. @pre it is alive and finalized
int instanceNumber(const btMultiBody& multi_body) noexcept;

/// Writes a number that RK4 integration has overwritten.
void setInstanceNumber(btMultiBody& multi_body, int number) noexcept;

/// Returns the number of a btMultiBody; gives it a new, unique one if it has none.
int giveInstanceNumber(btMultiBody& multi_body) noexcept;

AMBIENT_END
