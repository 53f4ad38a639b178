#pragma once

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

AMBIENT_BEGIN

/// Restores the sleep of an object. Call it last: other setters may wake the object.
void restoreSleep(const ObjectState& state, btCollisionObject& object);

/// Restores mass, inertia and gravity. Does not touch a body that has them already: the weight
/// depends, to rounding, on the order in which Bullet's setters are called.
void restoreMass(const BodyState& state, btRigidBody& body);

/// Restores everything except mass, sleep and fluid. @pre restoreMass() was called
void restoreBody(const BodyState& state, btRigidBody& body);

AMBIENT_END
