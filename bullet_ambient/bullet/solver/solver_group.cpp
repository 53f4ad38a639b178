#include "bullet_ambient/bullet/solver/solver_group.h"

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/bullet/rows/joint_rows.h"
#include "bullet_ambient/immersed/wrench_sensor.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/rows/row_velocity.h"

AMBIENT_BEGIN
namespace {

// Companion ids that tell what may move a body in this substep, while bodies are selected: Bullet
// overwrites the id when it converts the body. Bullet's own are from -2 on; -2: cannot move.
constexpr int kNotConverted = -1;
constexpr int kNear = -3;      // has a joint, or a pair with another body in the broadphase
constexpr int kRows = -4;      // has a joint or contact
constexpr int kAnchored = -5;  // has a joint, or a contact with a body that cannot move

// Returns one of these.
int markOf(const btCollisionObject& body) {
  const int id = body.getCompanionId();
  return id <= kNear && id >= kAnchored ? id : kNotConverted;
}

// Leaves bodies that cannot move alone: solvers of other groups may read them at the same time.
void mark(const btCollisionObject& body, int id) {
  if (body.isStaticOrKinematicObject() || !btRigidBody::upcast(&body)) return;
  // Bullet writes to bodies of manifolds, too.
  const_cast<btCollisionObject&>(body).setCompanionId(std::min(markOf(body), id));
}

// Marks the bodies in contact manifolds and joints.
void markPairs(const GroupInput& input) {
  for (int i = 0; i < input.manifold_count; ++i) {
    const btPersistentManifold& manifold = *input.manifolds[i];
    const bool has_rows = manifold.getNumContacts() > 0;
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    const auto idBeside = [has_rows](const btCollisionObject& other) {
      if (!has_rows) return kNear;
      return other.isStaticOrKinematicObject() ? kAnchored : kRows;
    };
    mark(a, idBeside(b));
    mark(b, idBeside(a));
  }
  for (int i = 0; i < input.constraint_count; ++i) {
    const btTypedConstraint& constraint = *input.constraints[i];
    if (!constraint.isEnabled()) continue;
    mark(constraint.getRigidBodyA(), kAnchored);
    mark(constraint.getRigidBodyB(), kAnchored);
  }
}

AmbientTree* treeOf(const AmbientTrees& trees, const btCollisionObject* object) {
  const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(object);
  return collider ? trees.find(collider->m_multiBody) : nullptr;
}

bool isOfOnePair(const btPersistentManifold& a, const btPersistentManifold& b) {
  return a.getBody0() == b.getBody0() && a.getBody1() == b.getBody1();
}

// By the parts that touch; without points last.
bool comesBefore(const btPersistentManifold& a, const btPersistentManifold& b) {
  if (a.getNumContacts() == 0 || b.getNumContacts() == 0)
    return a.getNumContacts() > b.getNumContacts();
  const btManifoldPoint &of_a = a.getContactPoint(0), &of_b = b.getContactPoint(0);
  return std::tie(of_a.m_index0, of_a.m_index1) < std::tie(of_b.m_index0, of_b.m_index1);
}

bool movesInFluid(const AmbientBodies& bodies, const btCollisionObject* object) {
  if (const AmbientTree* tree = treeOf(bodies.trees, object)) return isSolved(*tree);
  const AmbientBody* ambient = bodies.find(object);
  return ambient && ambient->isInFluid();
}

}  // namespace

SolverGroup::SolverGroup(AmbientBodies& bodies, const RowPools& pools)
    : bodies_(bodies),
      pools_(pools),
      joint_chains_(std::make_unique<JointChains>()),
      joint_errors_(std::make_unique<JointErrors>()) {}

SolverGroup::~SolverGroup() = default;

btPersistentManifold** SolverGroup::inOrderOfParts(btPersistentManifold** manifolds,
                                                   int count) noexcept {
  const auto isOutOfOrder = [this](const btPersistentManifold* a, const btPersistentManifold* b) {
    return isOfOnePair(*a, *b) && comesBefore(*b, *a) &&
           (movesInFluid(bodies_, a->getBody0()) || movesInFluid(bodies_, a->getBody1()));
  };
  if (std::adjacent_find(manifolds, manifolds + count, isOutOfOrder) == manifolds + count)
    return manifolds;
  ordered_.assign(manifolds, manifolds + count);  // Bullet's array may be that of its dispatcher
  for (auto next = ordered_.begin() + 1; next != ordered_.end(); ++next)
    for (auto at = next; at != ordered_.begin() && isOutOfOrder(*(at - 1), *at); --at)
      std::iter_swap(at - 1, at);
  return ordered_.data();
}

GroupBodies SolverGroup::select(const GroupBodies& bodies, const GroupInput& input,
                                btScalar time_step, bool all_stay) noexcept {
  time_step_ = static_cast<double>(time_step);
  members_.clear();
  saved_.clear();
  batch_count_ = 0;
  is_disabled_ = false;
  if (bodies_.size() == 0) return bodies;
  bodies_.solved.fetch_add(1, std::memory_order_relaxed);
  if (!std::isfinite(time_step_)) {
    is_disabled_ = disableAll(bodies);
    return bodies;
  }
  if (!hasAmbientBody(bodies)) return bodies;
  reserve(bodies.count);
  markPairs(input);
  findMembers(bodies, all_stay);
  return {converted_.data(), static_cast<int>(converted_.size())};
}

bool SolverGroup::hasAmbientBody(const GroupBodies& bodies) const noexcept {
  for (int i = 0; i < bodies.count; ++i)
    if (bodies_.find(bodies.first[i])) return true;
  return false;
}

// Reserves for all bodies of the group: the number of converted ones changes from step to step, and
// later steps must not allocate.
void SolverGroup::reserve(int bodies) noexcept {
  const auto count = static_cast<std::size_t>(bodies);
  free_.reserve(bodies_.task_runner ? count : kFlightsTogether);
  if (reserved_ >= bodies) return;
  reserved_ = bodies;
  members_.reserve(count);
  // Some solvers of Bullet convert one body more, which cannot move.
  converted_.reserve(count);
  member_of_solver_body_.reserve(count + 1);
  // One batch of bodies joined to multibodies may be begun besides.
  const std::size_t batches = count / kFlightsTogether + 2;
  if (batches_.size() < batches) batches_.resize(batches);
  row_bodies_.reserve(bodies + 1);
  joint_chains_->reserve(bodies);
}

// Fills members_ and converted_. Flies the ambient bodies that no row can move.
void SolverGroup::findMembers(const GroupBodies& bodies, bool all_stay) noexcept {
  converted_.clear();
  for (int i = 0; i < bodies.count; ++i) {
    btCollisionObject& object = *bodies.first[i];
    AmbientBody* ambient = bodies_.find(&object);
    if (!ambient || !prepareStep(*ambient, bodies_, time_step_)) {
      converted_.push_back(&object);
      continue;
    }
    stopIfNotFinite(*ambient, bodies_.warnings);
    const int mark = markOf(object);
    const bool is_locked = !axisFactors(*ambient->body).areFree();
    if (ambient->sensor)
      beginBodyReading(*ambient, readState(*ambient->body), readSurroundings(*ambient), is_locked);
    if (all_stay || is_locked || mark <= kNear) {
      converted_.push_back(&object);
      members_.push_back({ambient, is_locked, mark <= kRows, mark == kAnchored});
    } else {
      object.setCompanionId(kNotConverted);
      if (FlightQueue* queue = bodies_.flight_queue)
        queue->add(*ambient, bodies_, time_step_);
      else
        flyLater({ambient});
    }
  }
  flyFreely();
}

// Disables the ambient bodies, so that Bullet does not move them. Returns true if there are any.
bool SolverGroup::disableAll(const GroupBodies& bodies) noexcept {
  bool is_any = false;
  for (int i = 0; i < bodies.count; ++i) {
    AmbientBody* ambient = bodies_.find(bodies.first[i]);
    if (!ambient || !ambient->isInFluid() || ambient->body->isStaticOrKinematicObject()) continue;
    is_any = true;
    disable(*ambient, bodies_);
  }
  return is_any;
}

// Flies a body as soon as there are kFlightsTogether of them, while their data are in the cache; on
// several threads, when there is no further one.
void SolverGroup::flyLater(const FreeBody& body) noexcept {
  free_.push_back(body);
  if (!bodies_.task_runner && free_.size() == kFlightsTogether) flyFreely();
}

// Flies free_. A flight changes its own body only, so that any thread may compute it.
// kFlightsTogether flights side by side are quickest on one thread; few bodies are spread over the
// threads in smaller groups.
void SolverGroup::flyFreely() noexcept {
  if (free_.empty()) return;
  constexpr int kLeastGroups = 8;  // groups to make before a group is filled
  const int count = static_cast<int>(free_.size());
  const TaskRunner& runner = bodies_.task_runner;
  const int together =
      runner ? std::clamp(count / kLeastGroups, 1, kFlightsTogether) : kFlightsTogether;
  const auto flyGroup = [&](int group) {
    const int first = group * together;
    flyBodies(free_.data() + first, std::min(together, count - first), time_step_);
  };
  const int groups = (count + together - 1) / together;
  if (runner) {
    runner(groups, std::cref(flyGroup));  // allocates nothing
  } else {
    for (int i = 0; i < groups; ++i) flyGroup(i);
  }
  for (const FreeBody& body : free_) reportFlight(*body.ambient, bodies_.warnings);
  free_.clear();
}

void SolverGroup::goOn() noexcept {
  if (bodies_.flight_queue) bodies_.flight_queue->goOn();
}

void SolverGroup::showExternalChange(ExternalChange change) noexcept {
  for (const Member& member : members_) {
    const RowBody* row_body = row_bodies_.find(member.solver_body);
    if (!row_body) continue;
    btSolverBody& solver_body = pools_.solver_bodies[member.solver_body];
    solver_body.m_externalTorqueImpulse = row_body->spin_change;
    solver_body.m_externalForceImpulse = row_body->velocity_change;
    if (change == ExternalChange::kTrue) continue;
    solver_body.m_externalTorqueImpulse += row_body->spin_excess;
    solver_body.m_externalForceImpulse += row_body->velocity_excess;
  }
}

bool SolverGroup::needsSecondFriction(const btSolverConstraint& contact) noexcept {
  const btVector3& normal =
      static_cast<const btManifoldPoint*>(contact.m_originalContactPoint)->m_normalWorldOnB;
  const btVector3 push = pools_.solver_bodies[contact.m_solverBodyIdA].m_externalForceImpulse -
                         pools_.solver_bodies[contact.m_solverBodyIdB].m_externalForceImpulse;
  if (isTurnedInFrictionCone(contact, push, normal, row_bodies_)) return true;
  if (!isInFrictionCone(push, normal, contact.m_friction)) return false;
  for (const int id : {contact.m_solverBodyIdA, contact.m_solverBodyIdB}) {
    const Member* member = memberOf(id);
    if (member && deflects(*member->ambient, normal)) return true;
  }
  return false;
}

void SolverGroup::rewriteRows(const btContactSolverInfo& info) noexcept {
  const bool has_trees = pools_.multibodies && !bodies_.trees.empty();
  bounces_.clear();
  if (members_.empty() && !has_trees) return;
  if (pools_.multibodies && !members_.empty()) prepareJoinedToMultiBodies();
  if (row_bodies_.empty() && !has_trees) return;
  saveFeedbackJacobians();
  joint_errors_->watch(pools_, row_bodies_);
  bounces_.find(pools_, info, bodies_.trees, row_bodies_);
  const auto rewrite = [&](btConstraintArray& pool, RowKind kind, btScalar relaxation) {
    ambient::rewriteRows(pool, kind, relaxation, row_bodies_, pools_.solver_bodies);
  };
  rewrite(pools_.contacts, RowKind::kContact, info.m_sor);
  rewrite(pools_.frictions, RowKind::kFriction, info.m_sor);
  rewrite(pools_.torsional_frictions, RowKind::kTorsionalFriction, 1);
  rewrite(pools_.joints, RowKind::kJoint, 1);
  if (pools_.multibodies) rewriteMultiBodyRows(pools_, info, bodies_.trees, row_bodies_);
  reapplyWarmStart(info.m_solverMode);
}

bool SolverGroup::hasMembers() const noexcept {
  return !row_bodies_.empty() || !bodies_.trees.empty();
}

bool SolverGroup::touchesMember(btMultiBodySolverConstraint& row) noexcept {
  const auto isMember = [this](const RowSide& side) {
    return side.multibody ? bodies_.trees.findSolved(side.multibody) != nullptr
                          : row_bodies_.find(side.solver_body) != nullptr;
  };
  const auto [a, b] = sidesOf(row);
  return isMember(a) || isMember(b);
}

int SolverGroup::solveJoints() noexcept { return joint_chains_->solve(pools_, row_bodies_); }

void SolverGroup::resumeBounces() noexcept { bounces_.resume(pools_, bodies_.trees, row_bodies_); }

void SolverGroup::reapplyWarmStart(int solver_mode) noexcept {
  const bool for_multibodies =
      pools_.multibodies && (solver_mode & SOLVER_USE_ARTICULATED_WARMSTARTING);
  if (!(solver_mode & SOLVER_USE_WARMSTARTING) && !for_multibodies) return;
  for (const Member& member : members_) {
    btSolverBody& solver_body = pools_.solver_bodies[member.solver_body];
    solver_body.internalGetDeltaLinearVelocity().setZero();
    solver_body.internalGetDeltaAngularVelocity().setZero();
  }
  reapplyImpulses(pools_.contacts, row_bodies_, pools_.solver_bodies);
  if (!for_multibodies) return;
  // Stock Bullet applies the impulses of joints to the multibody only, which loses momentum.
  for (auto* pool :
       {&pools_.multibodies->contacts, &pools_.multibodies->frictions, &pools_.multibodies->joints})
    reapplyImpulses(*pool, row_bodies_, pools_.solver_bodies);
}

void SolverGroup::saveFeedbackJacobians() noexcept {
  for (int i = 0; i < pools_.joints.size(); ++i) {
    const btSolverConstraint& row = pools_.joints[i];
    if (!constraintOf(row)->getJointFeedback()) continue;
    saved_.push_back({i, row.m_relpos1CrossNormal, row.m_contactNormal1, row.m_relpos2CrossNormal,
                      row.m_contactNormal2});
  }
}

void SolverGroup::restoreFeedbackJacobians() noexcept {
  for (const SavedJacobian& saved : saved_) {
    btSolverConstraint& row = pools_.joints[saved.row];
    row.m_relpos1CrossNormal = saved.angular_a;
    row.m_contactNormal1 = saved.linear_a;
    row.m_relpos2CrossNormal = saved.angular_b;
    row.m_contactNormal2 = saved.linear_b;
  }
  saved_.clear();
}

SolverGroup::Member* SolverGroup::memberOf(int solver_body) noexcept {
  // Bodies appended after convertBodies (fixed, kinematic) are never ambient.
  if (static_cast<std::size_t>(solver_body) >= member_of_solver_body_.size()) return nullptr;
  const int index = member_of_solver_body_[solver_body];
  return index < 0 ? nullptr : &members_[index];
}

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
    bodies_.warnings.warnOnce(Warning::kOtherLinks);
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
  forEachTree(bodies_.trees, [this](AmbientTree& tree) {
    TreeStep& step = tree.step;
    if (isSolved(tree)) bodies_.warnings.warnOnce(Warning::kNoAction);
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
  const auto duration = static_cast<double>(info.m_timeStep);
  FlightQueue own;
  FlightQueue& queue = bodies_.flight_queue ? *bodies_.flight_queue : own;
  forEachTree(bodies_.trees, [&](AmbientTree& tree) {
    if (!prepareTree(tree, bodies_, duration)) queue.add(tree, bodies_, duration);
  });
  own.fly();
}

void TreeGroup::finish(const btContactSolverInfo& info) noexcept {
  if (bodies_.trees.empty()) return;
  if (is_begun_) bodies_.warnings.warnOnce(Warning::kNoMultiBodySolver);
  is_begun_ = false;
  forEachTree(bodies_.trees, [&](AmbientTree& tree) {
    finishTree(tree, bodies_, static_cast<double>(info.m_timeStep));
  });
}

AMBIENT_END
