#pragma once

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"

AMBIENT_BEGIN

/// Substep of the world of the trees.
struct TreeTask {
  AmbientBodies& bodies;
  double duration;  ///< [s]
  btVector3 gravity;
};

/// Makes the task of a substep of `time_step` [s]. @pre there are trees
inline TreeTask taskOf(AmbientBodies& bodies, btScalar time_step) {
  return {bodies, static_cast<double>(time_step), bodies.trees.world()->getGravity()};
}

/// Calls visit(AmbientTree&) for each tree whose multibody is in the world. Multibodies outside it
/// may have been destroyed.
template <class Visit>
void forEachTree(btMultiBodyDynamicsWorld& world, const AmbientTrees& trees, const Visit& visit) {
  for (int i = 0; i < world.getNumMultibodies(); ++i)
    if (AmbientTree* tree = trees.find(world.getMultiBody(i))) visit(*tree);
}

AMBIENT_END
