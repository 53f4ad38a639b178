#include "bullet_ambient/bullet/tree_group.h"

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/attach_link.h"
#include "bullet_ambient/bullet/fluid_drawing.h"
#include "bullet_ambient/bullet/tree_links.h"
#include "bullet_ambient/bullet/tree_motion.h"
#include "bullet_ambient/bullet/tree_state.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// Rows of a tree's own joints: their Jacobians stay as they are while it moves.
bool isOfJoints(int constraint_type) {
  switch (constraint_type) {
    case MULTIBODY_CONSTRAINT_LIMIT:
    case MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR:
    case MULTIBODY_CONSTRAINT_GEAR:
    case MULTIBODY_CONSTRAINT_SPHERICAL_MOTOR:
    case MULTIBODY_CONSTRAINT_SPHERICAL_LIMIT:
      return true;
    default:
      return false;
  }
}

AmbientTree* treeOf(const AmbientTrees& trees, const btCollisionObject* object) {
  const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(object);
  return collider ? trees.find(collider->m_multiBody) : nullptr;
}

void markTurning(AmbientTree* tree) {
  if (tree) tree->step.turns_rows = true;
}

// Those that the world has: others may have been destroyed.
template <class Visit>
void forEachTree(btMultiBodyDynamicsWorld& world, const AmbientTrees& trees, const Visit& visit) {
  for (int i = 0; i < world.getNumMultibodies(); ++i)
    if (AmbientTree* tree = trees.find(world.getMultiBody(i))) visit(*tree);
}

bool isOf(const btCollisionWorld& world, const AmbientTrees& trees) {
  return !trees.empty() && trees.world() == &world;
}

TreeTask taskOf(AmbientBodies& bodies, btScalar time_step) {
  return {bodies, static_cast<double>(time_step), bodies.trees.world()->getGravity()};
}

}  // namespace

TreeGroup::TreeGroup(AmbientRegistry& registry) : bodies_(bodiesOf(registry)) {}

// Bullet numbers rigid bodies and not these: other links tell another one at the same address.
void TreeGroup::dropStrangers() noexcept {
  btMultiBodyDynamicsWorld& world = *bodies_.trees.world();
  for (int i = 0; i < world.getNumMultibodies(); ++i) {
    const btMultiBody& body = *world.getMultiBody(i);
    const AmbientTree* tree = bodies_.trees.find(&body);
    if (!tree || hasLinksOf(body, tree->tree)) continue;
    bodies_.complaints.say(Complaint::kOtherLinks);
    bodies_.trees.erase(body);
    if (bodies_.trees.empty()) return;
  }
}

void TreeGroup::begin() noexcept {
  is_begun_ = false;
  if (bodies_.trees.empty()) return;
  dropStrangers();
  if (bodies_.trees.empty()) return;
  is_begun_ = true;
  forEachTree(*bodies_.trees.world(), bodies_.trees, [this](AmbientTree& tree) {
    TreeStep& step = tree.step;
    if (hasMet(tree)) bodies_.complaints.say(Complaint::kNoAction);
    step.outcome = TreeOutcome::kNotMet;
    step.was_awake = !isAsleep(*tree.multi_body);
    step.turns_rows = false;
    readVelocity(*tree.multi_body, step.start);
  });
}

void TreeGroup::markTurningRows() noexcept {
  btMultiBodyDynamicsWorld& world = *bodies_.trees.world();
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    if (manifold.getNumContacts() == 0) continue;
    markTurning(treeOf(bodies_.trees, manifold.getBody0()));
    markTurning(treeOf(bodies_.trees, manifold.getBody1()));
  }
  for (int i = 0; i < world.getNumMultiBodyConstraints(); ++i) {
    btMultiBodyConstraint& constraint = *world.getMultiBodyConstraint(i);
    if (isOfJoints(constraint.getConstraintType())) continue;
    markTurning(bodies_.trees.find(constraint.getMultiBodyA()));
    markTurning(bodies_.trees.find(constraint.getMultiBodyB()));
  }
}

void TreeGroup::meet(const btContactSolverInfo& info) noexcept {
  if (!is_begun_) return;
  is_begun_ = false;
  bodies_.solved.fetch_add(1, std::memory_order_relaxed);
  markTurningRows();
  const TreeTask task = taskOf(bodies_, info.m_timeStep);
  forEachTree(*bodies_.trees.world(), bodies_.trees,
              [&task](AmbientTree& tree) { meetTree(tree, task); });
}

const AmbientTrees* TreeGroup::met() const noexcept {
  return bodies_.trees.empty() ? nullptr : &bodies_.trees;
}

void TreeGroup::finish(const btContactSolverInfo& info) noexcept {
  if (bodies_.trees.empty()) return;
  if (is_begun_) bodies_.complaints.say(Complaint::kNoMultiBodySolver);
  is_begun_ = false;
  const TreeTask task = taskOf(bodies_, info.m_timeStep);
  forEachTree(*bodies_.trees.world(), bodies_.trees,
              [&task](AmbientTree& tree) { finishTree(tree, task); });
}

bool hasAwakeTree(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept {
  if (!isOf(world, bodies.trees)) return false;
  bool is_awake = false;
  forEachTree(*bodies.trees.world(), bodies.trees,
              [&is_awake](const AmbientTree& tree) { is_awake |= !isAsleep(*tree.multi_body); });
  return is_awake;
}

void wakeFollowingTrees(const btCollisionWorld& world, const AmbientBodies& bodies) noexcept {
  if (!isOf(world, bodies.trees)) return;
  forEachTree(*bodies.trees.world(), bodies.trees, [](const AmbientTree& tree) {
    for (const auto& link : tree.links)
      if (link->ambient.def.follow_regions) return wake(*tree.multi_body);
  });
}

void drawTrees(const btCollisionWorld& world, const AmbientBodies& bodies, const FluidDrawing& what,
               btIDebugDraw& drawer) {
  if (!isOf(world, bodies.trees)) return;
  forEachTree(*bodies.trees.world(), bodies.trees, [&](AmbientTree& tree) {
    moveStandIns(tree);
    for (const auto& link : tree.links) {
      const bool is_in_fluid =
          link->ambient.isInFluid() && !link->stand_in.isStaticOrKinematicObject();
      if (is_in_fluid) drawFluid(link->ambient, what, drawer);
    }
  });
}

void completeTrees(const btCollisionWorld& world, AmbientBodies& bodies,
                   double time_step) noexcept {
  if (!isOf(world, bodies.trees)) return;
  const TreeTask task = taskOf(bodies, static_cast<btScalar>(time_step));
  forEachTree(*bodies.trees.world(), bodies.trees,
              [&task](AmbientTree& tree) { completeTree(tree, task); });
  for (const auto& tree : bodies.trees.all()) tree->step.outcome = TreeOutcome::kNotMet;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
