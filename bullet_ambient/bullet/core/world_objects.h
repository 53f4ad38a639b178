#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

/// Lists the rigid bodies of a world in the order of its array, which is also their order in a
/// .bullet file.
inline std::vector<btRigidBody*> rigidBodiesOf(btCollisionWorld& world) {
  std::vector<btRigidBody*> bodies;
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    if (btRigidBody* body = btRigidBody::upcast(objects[i])) bodies.push_back(body);
  }
  return bodies;
}

/// Returns the rigid bodies of a world in that order, then all other objects.
inline std::vector<btCollisionObject*> objectsOf(btCollisionWorld& world) {
  const std::vector<btRigidBody*> bodies = rigidBodiesOf(world);
  std::vector<btCollisionObject*> result(bodies.begin(), bodies.end());
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    if (!btRigidBody::upcast(objects[i])) result.push_back(objects[i]);
  }
  return result;
}

AMBIENT_END
