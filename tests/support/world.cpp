#include "tests/support/world.h"

#include <algorithm>

namespace ambient::test {

WorldContents::~WorldContents() {
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
  for (const auto& joint : tree_joints_) treeWorld().removeMultiBodyConstraint(joint.get());
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  while (!trees_.empty()) remove(*trees_.back());
}

btRigidBody& WorldContents::add(double mass, const btVector3& moments, btCollisionShape& shape,
                                const btTransform& pose) {
  bodies_.push_back(
      std::make_unique<btRigidBody>(static_cast<btScalar>(mass), nullptr, &shape, moments));
  btRigidBody& body = *bodies_.back();
  body.setWorldTransform(pose);
  world_.addRigidBody(&body);
  return body;
}

btRigidBody& WorldContents::add(double mass, btCollisionShape& shape, const btTransform& pose) {
  btVector3 moments(0, 0, 0);
  if (mass > 0) shape.calculateLocalInertia(static_cast<btScalar>(mass), moments);
  return add(mass, moments, shape, pose);
}

btMultiBodyLinkCollider& WorldContents::addCollider(btMultiBody& tree, int link,
                                                    btCollisionShape& shape, int mask) {
  auto* collider = new btMultiBodyLinkCollider(&tree, link);  // remove() deletes it
  collider->setCollisionShape(&shape);
  world_.addCollisionObject(collider, btBroadphaseProxy::DefaultFilter, mask);
  if (link < 0) {
    tree.setBaseCollider(collider);
  } else {
    tree.getLink(link).m_collider = collider;
  }
  return *collider;
}

void WorldContents::own(std::unique_ptr<btTypedConstraint> joint, bool may_touch) {
  world_.addConstraint(joint.get(), !may_touch);
  joints_.push_back(std::move(joint));
}

void WorldContents::own(std::unique_ptr<btMultiBodyConstraint> joint) {
  treeWorld().addMultiBodyConstraint(joint.get());
  tree_joints_.push_back(std::move(joint));
}

void WorldContents::own(std::unique_ptr<btMultiBody> tree) {
  treeWorld().addMultiBody(tree.get());
  trees_.push_back(std::move(tree));
}

void WorldContents::remove(btMultiBody& tree) {
  treeWorld().removeMultiBody(&tree);
  for (int i = -1; i < tree.getNumLinks(); ++i) {
    btMultiBodyLinkCollider* collider = i < 0 ? tree.getBaseCollider() : tree.getLinkCollider(i);
    if (!collider) continue;
    world_.removeCollisionObject(collider);
    delete collider;
  }
  trees_.erase(std::find_if(trees_.begin(), trees_.end(),
                            [&tree](const auto& owned) { return owned.get() == &tree; }));
}

void WorldContents::removeLast() {
  world_.removeRigidBody(bodies_.back().get());
  bodies_.pop_back();
}

void WorldContents::step(double duration, int count) {
  const auto dt = static_cast<btScalar>(duration);
  for (int i = 0; i < count; ++i) world_.stepSimulation(dt, 0, dt);
}

}  // namespace ambient::test
