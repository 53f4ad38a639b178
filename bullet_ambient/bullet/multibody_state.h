#pragma once

#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/world_state.h"

class btCollisionWorld;
class btMultiBody;
class btMultiBodyConstraint;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Those of a btMultiBodyDynamicsWorld in its order; of other worlds none.
std::vector<btMultiBody*> multiBodiesOf(btCollisionWorld& world);
std::vector<btMultiBodyConstraint*> multiBodyJointsOf(btCollisionWorld& world);

/// All but its fluids.
MultiBodyState saveMultiBody(const btMultiBody& body);
MultiBodyJointState saveJoint(const btMultiBodyConstraint& joint);

/// @throws std::invalid_argument with one sentence if the state is of other links, colliders or
/// joints, or a position of a joint is none. `number`: in the world, for that sentence.
void requireFits(const MultiBodyState& state, const btMultiBody& body, std::size_t number);
void requireFits(const MultiBodyJointState& state, const btMultiBodyConstraint& joint,
                 std::size_t number);

/// All but sleep and fluids. @pre it fits
void restoreMultiBody(const MultiBodyState& state, btMultiBody& body);
void restoreJoint(const MultiBodyJointState& state, btMultiBodyConstraint& joint);

/// Of it and its colliders; last, as restoreSleep() of an object.
void restoreSleep(const MultiBodyState& state, btMultiBody& body);

/// Has Bullet's collision detection take its colliders for awake.
void wakeColliders(btMultiBody& body);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
