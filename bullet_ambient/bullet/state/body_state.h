#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

AMBIENT_BEGIN

/// Last: whatever else is done to an object may wake it.
void restoreSleep(const ObjectState& state, btCollisionObject& object);

/// Mass, inertia and gravity. A body that has them already is not touched: Bullet's weight depends
/// to a rounding on the order in which they were set.
void restoreMass(const BodyState& state, btRigidBody& body);

/// All but mass, sleep and fluid. @pre restoreMass() was called.
void restoreBody(const BodyState& state, btRigidBody& body);

AMBIENT_END
