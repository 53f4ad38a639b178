#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <utility>
#include <vector>

namespace ambient::test {

/// Owner of the bodies, joints and trees of a world. They leave the world before they are deleted.
class WorldContents {
 public:
  explicit WorldContents(btDiscreteDynamicsWorld& world) : world_(world) {}
  ~WorldContents();
  WorldContents(const WorldContents&) = delete;
  WorldContents& operator=(const WorldContents&) = delete;

  /// Makes a body at rest. Mass [kg]; 0: it never moves. Principal moments [kg m^2].
  btRigidBody& add(double mass, const btVector3& moments, btCollisionShape& shape,
                   const btTransform& pose);
  /// The same with the moments that Bullet has for the shape.
  btRigidBody& add(double mass, btCollisionShape& shape,
                   const btTransform& pose = btTransform::getIdentity());
  /// Makes the collider of a link, or of the base, which is link -1. It touches groups of `mask`.
  btMultiBodyLinkCollider& addCollider(btMultiBody& tree, int link, btCollisionShape& shape,
                                       int mask = btBroadphaseProxy::AllFilter);
  /// Joints, trees and their joints; trees and their joints: @pre a world of multibodies.
  template <class Owned>
  Owned& take(std::unique_ptr<Owned> owned) {
    Owned& taken = *owned;
    own(std::move(owned));
    return taken;
  }
  /// A joint of bodies that do not touch each other.
  template <class Joint>
  Joint& join(std::unique_ptr<Joint> joint) {
    Joint& taken = *joint;
    own(std::move(joint), false);
    return taken;
  }
  /// Deletes a tree and its colliders. Its joints are gone by then.
  void remove(btMultiBody& tree);
  /// Deletes the body that was made last.
  void removeLast();

  void step(double duration, int count = 1);

  /// In the order in which they were made.
  const std::vector<std::unique_ptr<btRigidBody>>& bodies() const { return bodies_; }
  const std::vector<std::unique_ptr<btTypedConstraint>>& joints() const { return joints_; }

 private:
  void own(std::unique_ptr<btTypedConstraint> joint, bool may_touch = true);
  void own(std::unique_ptr<btMultiBodyConstraint> joint);
  void own(std::unique_ptr<btMultiBody> tree);
  btMultiBodyDynamicsWorld& treeWorld() { return dynamic_cast<btMultiBodyDynamicsWorld&>(world_); }

  btDiscreteDynamicsWorld& world_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
  std::vector<std::unique_ptr<btMultiBody>> trees_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> tree_joints_;
};

/// What a world needs besides its solver; for worlds of any type.
template <class Broadphase = btDbvtBroadphase>
struct WorldParts {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  Broadphase broadphase;
};

/// A world of any type with a stock solver, what it needs and what is in it.
template <class World = btDiscreteDynamicsWorld, class Solver = btSequentialImpulseConstraintSolver>
struct WholeWorld : WorldParts<> {
  void step(double duration, int count = 1) { contents.step(duration, count); }

  Solver solver;
  World world{&dispatcher, &broadphase, &solver, &configuration};
  WorldContents contents{world};
};

using TreeWorld = WholeWorld<btMultiBodyDynamicsWorld, btMultiBodyConstraintSolver>;

}  // namespace ambient::test
