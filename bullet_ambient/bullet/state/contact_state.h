#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

class btCollisionWorld;

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

/// Saves the overlapping pairs in Bullet's order.
std::vector<PairState> savePairs(btCollisionWorld& world);

/// Saves the contact points in Bullet's order.
std::vector<ContactState> saveContacts(btCollisionWorld& world);

/// Saves the bounding boxes in a btDbvtBroadphase, and where it looks for pairs that are apart.
void saveBoxes(btCollisionWorld& world, WorldState& state);

/// Restores pairs, contact points and boxes, the former two in the saved order: adds the saved
/// pairs to the overlapping ones, runs the world's collision detection to make manifolds, and fills
/// in the saved points. All other manifolds become empty. Leaves dynamic bodies awake. @pre the
/// bodies have their saved poses
void restoreContacts(const WorldState& state, btCollisionWorld& world);

AMBIENT_END
