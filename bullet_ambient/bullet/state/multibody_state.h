#pragma once

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

class btCollisionWorld;
class btMultiBody;
class btMultiBodyConstraint;

AMBIENT_BEGIN

/// Multibodies of a btMultiBodyDynamicsWorld in its order; other worlds have none.
std::vector<btMultiBody*> multiBodiesOf(btCollisionWorld& world);
std::vector<btMultiBodyConstraint*> multiBodyJointsOf(btCollisionWorld& world);

/// All but its fluids.
MultiBodyState saveMultiBody(btMultiBody& body);
MultiBodyJointState saveJoint(btMultiBodyConstraint& joint);

/// @throws std::invalid_argument with one sentence if the state is of other links, colliders or
/// joints, or a position of a joint is none. `number`: in the world, for that sentence.
void requireFits(const MultiBodyState& state, const btMultiBody& body, std::size_t number);
void requireFits(const MultiBodyJointState& state, const btMultiBodyConstraint& joint,
                 std::size_t number);

/// All but sleep and fluids. @pre it fits
void restoreMultiBody(const MultiBodyState& state, btMultiBody& body);
void restoreJoint(const MultiBodyJointState& state, btMultiBodyConstraint& joint);

/// Restores sleep of a multibody and its colliders. Call it last: other setters wake them.
void restoreSleep(const MultiBodyState& state, btMultiBody& body);

/// Has Bullet's collision detection take its colliders for awake.
void wakeColliders(btMultiBody& body);

AMBIENT_END
