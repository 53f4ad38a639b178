#include "bullet_ambient/bullet/solver/tree_group.h"

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <utility>

#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/motion/flight/flight_task.h"

AMBIENT_BEGIN
namespace {

// Value of MULTIBODY_CONSTRAINT_SPHERICAL_LIMIT, which Bullet has since 3.22.
constexpr int kSphericalLimit = MULTIBODY_CONSTRAINT_FIXED + 1;

// True for limits, motors and gears of a tree's own joints, whose Jacobians do not change while the
// tree moves.
bool isOfJoints(int constraint_type) {
  switch (constraint_type) {
    case MULTIBODY_CONSTRAINT_LIMIT:
    case MULTIBODY_CONSTRAINT_1DOF_JOINT_MOTOR:
    case MULTIBODY_CONSTRAINT_GEAR:
    case MULTIBODY_CONSTRAINT_SPHERICAL_MOTOR:
    case kSphericalLimit:
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

}  // namespace

TreeGroup::TreeGroup(AmbientBodies& bodies) : bodies_(bodies) {}

void TreeGroup::detachReplacedTrees() noexcept {
  btMultiBodyDynamicsWorld& world = *bodies_.trees.world();
  for (int i = 0; i < world.getNumMultibodies(); ++i) {
    const btMultiBody& body = *world.getMultiBody(i);
    const AmbientTree* tree = bodies_.trees.at(&body);
    if (!tree || (tree->isSame() && hasLinksOf(body, tree->tree))) continue;
    bodies_.complaints.say(Complaint::kOtherLinks);
    bodies_.trees.erase(body);
    if (bodies_.trees.empty()) return;
  }
}

void TreeGroup::begin() noexcept {
  is_begun_ = false;
  if (bodies_.trees.empty()) return;
  detachReplacedTrees();
  if (bodies_.trees.empty()) return;
  is_begun_ = true;
  forEachTree(*bodies_.trees.world(), bodies_.trees, [this](AmbientTree& tree) {
    TreeStep& step = tree.step;
    if (isSolved(tree)) bodies_.complaints.say(Complaint::kNoAction);
    step.outcome = Outcome::kNotSolved;
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

void TreeGroup::prepare(const btContactSolverInfo& info) noexcept {
  if (!is_begun_) return;
  is_begun_ = false;
  bodies_.solved.fetch_add(1, std::memory_order_relaxed);
  markTurningRows();
  const TreeTask task = taskOf(bodies_, info.m_timeStep);
  AmbientTree* lone[kFlightsTogether];
  int count = 0;
  forEachTree(*bodies_.trees.world(), bodies_.trees, [&](AmbientTree& tree) {
    if (prepareTree(tree, task)) return;
    lone[count++] = &tree;
    if (count == kFlightsTogether) flyLoneTrees(lone, std::exchange(count, 0), task);
  });
  if (count > 0) flyLoneTrees(lone, count, task);
}

const AmbientTrees* TreeGroup::solvedTrees() const noexcept {
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

AMBIENT_END
