#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <functional>
#include <memory>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/state/world_state_fields.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"

class btMultiBodyConstraint;

AMBIENT_BEGIN

/// Visitor that copies fields from an object of Bullet, or sets those of the object in order, but
/// for those with SetElsewhere.
template <class Object, bool kSets>
struct BulletFields : FieldVisitor {
  explicit BulletFields(Object& of) : object(of) {}

  template <class Field>
  void operator()(Field&, const Rule&) {}
  template <class Field, class Get, class Set>
  void operator()(Field& field, const Rule&, const Get& get, const Set& set) {
    if constexpr (kSets) {
      std::invoke(set, object, field);
    } else {
      field = std::invoke(get, object);
    }
  }
  Object& object;
};

template <class State, class Object>
State fromBullet(Object& object) {
  State state;
  BulletFields<Object, false> visitor(object);
  fields(visitor, state);
  return state;
}

template <class State, class Object>
void toBullet(const State& state, Object& object) {
  BulletFields<Object, true> visitor(object);
  visit(visitor, state);
}

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

/// Restores the sleep of an object. Call it last: other setters may wake the object.
void restoreSleep(const ObjectState& state, btCollisionObject& object);

/// Restores mass, inertia and gravity. Does not touch a body that has them already: the weight
/// depends, to rounding, on the order in which Bullet's setters are called.
void restoreMass(const BodyState& state, btRigidBody& body);

/// Restores everything except mass, sleep and fluid. @pre restoreMass() was called
void restoreBody(const BodyState& state, btRigidBody& body);

/// Multibodies of a btMultiBodyDynamicsWorld in its order; other worlds have none.
std::vector<btMultiBody*> multiBodiesOf(btCollisionWorld& world);
std::vector<btMultiBodyConstraint*> multiBodyJointsOf(btCollisionWorld& world);

/// Saves a multibody without its fluids.
MultiBodyState saveMultiBody(btMultiBody& body);
MultiBodyJointState saveJoint(btMultiBodyConstraint& joint);

/// @throws std::invalid_argument with one sentence if links, colliders or joints differ from those
/// of the state, or a joint position is invalid. `number`: index in the world, for the message.
void requireFits(const MultiBodyState& state, const btMultiBody& body, std::size_t number);
void requireFits(const MultiBodyJointState& state, const btMultiBodyConstraint& joint,
                 std::size_t number);

/// Restores everything except sleep and fluids. @pre requireFits() has passed
void restoreMultiBody(const MultiBodyState& state, btMultiBody& body);
void restoreJoint(const MultiBodyJointState& state, btMultiBodyConstraint& joint);

/// Restores sleep of a multibody and its colliders. Call it last: other setters wake them.
void restoreSleep(const MultiBodyState& state, btMultiBody& body);

/// Makes Bullet's collision detection treat the colliders as awake.
void wakeColliders(btMultiBody& body);

/// Saves the fluid of a body or link.
AmbientState saveAmbient(const AmbientBody& ambient, const InverseMass& mass);

/// Saves the fluids of the links of a tree, and the memory of its flight; not its motion.
void saveFluids(const AmbientTree& tree, MultiBodyState& state);

/// Makes the entry of a body or link of this mass in its fluid from a saved state. `before`: its
/// entry now, whose foils stay; null: it is in no fluid.
/// @throws std::invalid_argument if the fluid body is missing or a number is not physical.
AmbientBody makeAmbient(const AmbientState& saved, const InverseMass& mass,
                        AmbientBodies& registered, const AmbientBody* before);

/// Gives a body or link at a surface the flotation that its last substep has left. Returns false,
/// and changes nothing, if it is at none.
bool floatAgain(AmbientBody& ambient, const RigidState& now, const FluidRegions& regions) noexcept;

/// Makes the entries of all links of a multibody that are in a fluid, from a saved state, as
/// makeAmbient(). Does not add them.
/// @throws std::invalid_argument as makeAmbient(), or if there is no such link.
std::vector<std::unique_ptr<AmbientLink>> makeLinks(const MultiBodyState& state,
                                                    const btMultiBody& body,
                                                    AmbientBodies& registered);

/// Adds the links of makeLinks() in place of the present ones.
/// @pre the multibody is of this state
void insertLinks(const MultiBodyState& state, std::vector<std::unique_ptr<AmbientLink>> links,
                 btMultiBodyDynamicsWorld& world, btMultiBody& body, AmbientBodies& registered);

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
