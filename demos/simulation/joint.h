#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "demos/scene/scene.h"

namespace ambient {

/// Makes Bullet's constraint for a joint; both bodies are in their poses at t = 0. `second`: null
/// for a joint to the world.
/// @throws std::invalid_argument in one line if the point is over 2^23 body sizes from a body.
std::unique_ptr<btTypedConstraint> makeJoint(const JointDef& joint, btRigidBody& first,
                                             btRigidBody* second);

}  // namespace ambient
