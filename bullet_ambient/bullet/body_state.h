#pragma once

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/world_state.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// What a rigid body and a link's collider share.
ObjectState saveObject(const btCollisionObject& object);

/// All but sleep.
void restoreObject(const ObjectState& state, btCollisionObject& object);

/// Last: whatever else is done to an object may wake it.
void restoreSleep(const ObjectState& state, btCollisionObject& object);

/// All but its fluid.
BodyState saveBody(const btRigidBody& body);

/// Mass, inertia and gravity. A body that has them already is not touched: Bullet's weight depends
/// to a rounding on the order in which they were set.
void restoreMass(const BodyState& state, btRigidBody& body);

/// All but mass, sleep and fluid. @pre restoreMass() was called.
void restoreBody(const BodyState& state, btRigidBody& body);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
