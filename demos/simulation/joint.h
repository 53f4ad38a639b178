#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "demos/scene/scene.h"

namespace ambient {

/// Bullet's constraint of a joint between bodies in their poses at t = 0; `second` is null for a
/// joint to the world.
/// @throws std::invalid_argument in one line if its point is out of all proportion to a body.
std::unique_ptr<btTypedConstraint> makeJoint(const JointDef& joint, btRigidBody& first,
                                             btRigidBody* second);

}  // namespace ambient
