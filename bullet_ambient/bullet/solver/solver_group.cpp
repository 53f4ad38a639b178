#include "bullet_ambient/bullet/solver/solver_group.h"

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <algorithm>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/task_runner.h"
#include "bullet_ambient/bullet/links/multibody_rows.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/reading/body_reading.h"
#include "bullet_ambient/bullet/rows/joint_chains.h"
#include "bullet_ambient/bullet/rows/joint_gaps.h"
#include "bullet_ambient/bullet/rows/row_motion.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"
#include "bullet_ambient/bullet/rows/slope_friction.h"
#include "bullet_ambient/immersed/surface_encounter.h"
#include "bullet_ambient/motion/flight/axis_locks.h"
#include "bullet_ambient/motion/flight/row_velocity.h"

AMBIENT_BEGIN
namespace {

bool isZero(const btVector3& v) { return v.x() == 0 && v.y() == 0 && v.z() == 0; }

// No row has moved the body: neither its velocity nor, by split impulses, its position.
bool isUntouched(btSolverBody& b) {
  return isZero(b.internalGetDeltaLinearVelocity()) &&
         isZero(b.internalGetDeltaAngularVelocity()) && isZero(b.internalGetPushVelocity()) &&
         isZero(b.internalGetTurnVelocity());
}

void fromBasis(const WorldBasis& T, btVector3& angular, btVector3& linear) {
  angular = T.angular * angular + T.coupling * linear;
  linear = T.linear * linear;
}

// Returns the velocity basis, which changes at the surface of the water.
Matrix6 basisOf(const AmbientBody& ambient) {
  if (!ambient.surface()) return ambient.basis_B;
  const Vector3 inverse_inertia = toVector3(ambient.body->getInvInertiaDiagLocal());
  return makeVelocityBasis(ambient.model, inverse_inertia.cwiseInverse());
}

void setExternalImpulse(btSolverBody& solver_body, const Twist& change_W) {
  solver_body.m_externalTorqueImpulse = toBullet(change_W.angular);
  solver_body.m_externalForceImpulse = toBullet(change_W.linear);
}

// Adds a change of velocity like Bullet's write-back.
void addVelocity(btRigidBody& body, const Twist& change_W) {
  body.setAngularVelocity(body.getAngularVelocity() + toBullet(change_W.angular));
  body.setLinearVelocity(body.getLinearVelocity() + toBullet(change_W.linear));
}

btVector3 whereZero(const btVector3& v) {
  return {btScalar(v.x() == 0), btScalar(v.y() == 0), btScalar(v.z() == 0)};
}

// Rows take the locks from T: the solver must not apply them again.
void lock(RowBody& row_body, const AmbientBody& ambient, const AxisFactors& factors,
          btSolverBody& solver_body) {
  const btRigidBody& body = *ambient.body;
  const Vector3 inertia = toVector3(body.getInvInertiaDiagLocal()).cwiseInverse();
  const Matrix3 R = readState(body).orientation.toRotationMatrix();
  const Matrix3 root = rootInertia(inertia, R);
  row_body.is_locked = true;
  row_body.basis = makeLockedBasis(ambient.model, root, R, factors);
  row_body.root_inertia = toBulletMatrix(root);
  row_body.locked_angular = whereZero(body.getAngularFactor());
  row_body.locked_linear = whereZero(body.getLinearFactor());
  solver_body.m_angularFactor.setValue(1, 1, 1);
  solver_body.m_linearFactor.setValue(1, 1, 1);
  solver_body.internalSetInvMass(btVector3(1, 1, 1) * body.getInvMass());
}

bool isFinite(btSolverBody& b) {
  const btVector3 linear =
      b.m_linearVelocity + b.internalGetDeltaLinearVelocity() + b.m_externalForceImpulse;
  const btVector3 angular =
      b.m_angularVelocity + b.internalGetDeltaAngularVelocity() + b.m_externalTorqueImpulse;
  return toVector3(linear).allFinite() && toVector3(angular).allFinite() &&
         toVector3(b.internalGetPushVelocity()).allFinite() &&
         toVector3(b.internalGetTurnVelocity()).allFinite();
}

void dropRows(btSolverBody& b) {
  for (btVector3* change :
       {&b.internalGetDeltaLinearVelocity(), &b.internalGetDeltaAngularVelocity(),
        &b.internalGetPushVelocity(), &b.internalGetTurnVelocity(), &b.m_externalForceImpulse,
        &b.m_externalTorqueImpulse})
    change->setZero();
}

// Velocity changes back into Bullet's basis; false if they are not finite, and dropped.
bool finishRows(AmbientBody& ambient, const RowBody& row_body, btSolverBody& b, double time_step) {
  const bool is_adrift = isUntouched(b);
  ambient.outcome.kind = is_adrift ? Outcome::kAdrift : Outcome::kRows;
  if (!is_adrift) {
    fromBasis(row_body.basis, b.internalGetDeltaAngularVelocity(),
              b.internalGetDeltaLinearVelocity());
    fromBasis(row_body.basis, b.internalGetTurnVelocity(), b.internalGetPushVelocity());
  }
  ambient.memory = {};
  if (ambient.surface()) ambient.encounter.waves = ambient.encounter.waves_with_rows;
  if (!isFinite(b)) {
    dropRows(b);
    ++ambient.counters.rejected;
    return false;
  }
  beginRowMotion(ambient, row_body, b, time_step);
  if (ambient.reading) readRows(ambient, b);
  return true;
}

// A function of the item as a task; holds no memory of its own.
template <class Fly>
class FlightTasks final : public Task {
 public:
  explicit FlightTasks(const Fly& fly) : fly_(fly) {}
  void run(int item) const noexcept override { fly_(item); }

 private:
  const Fly& fly_;
};

}  // namespace

SolverGroup::SolverGroup(AmbientBodies& bodies)
    : bodies_(bodies),
      row_bodies_(std::make_unique<RowBodies>()),
      joint_chains_(std::make_unique<JointChains>()),
      joint_gaps_(std::make_unique<JointGaps>()) {}

SolverGroup::~SolverGroup() = default;

void SolverGroup::begin(SolverBodies& solver_bodies) noexcept {
  may_hold_slopes_ = false;
  if (members_.empty()) {
    row_bodies_->reset(0);
    return;
  }
  member_of_solver_body_.assign(solver_bodies.size(), -1);
  row_bodies_->reset(solver_bodies.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& member = members_[i];
    member.solver_body = member.ambient->body->getCompanionId();
    if (member.solver_body == kAlone) continue;
    AMBIENT_ASSERT(member.solver_body >= 0 && member.solver_body < solver_bodies.size());
    member_of_solver_body_[member.solver_body] = static_cast<int>(i);
    btSolverBody& solver_body = solver_bodies[member.solver_body];
    if (member.has_rows || member.is_locked) {
      may_hold_slopes_ = may_hold_slopes_ || mayTurnAside(*member.ambient);
      prepareForRows(member, solver_body);
    } else {
      setExternalImpulse(solver_body, Twist{});
    }
  }
}

void SolverGroup::prepareForRows(Member& member, btSolverBody& solver_body) noexcept {
  AmbientBody& ambient = *member.ambient;
  // Bullet's setWorldTransform leaves the tensor of the old orientation, to which T does not fit.
  AMBIENT_ASSERT(ambient.body->getInvMass() > 0);
  ambient.body->updateInertiaTensor();
  const btRigidBody& body = *ambient.body;
  const RigidState start = readState(body);
  Vector6 by_surface = Vector6::Zero();
  if (ambient.surface()) {
    freezeAtSurface(ambient);
    by_surface = kickByWavesAndWind(ambient, time_step_);
    stiffenForRows(ambient, time_step_, bodies_.complaints);
  }
  const Surroundings surroundings = readSurroundings(ambient);
  const FlightTask task{ambient.model, surroundings, ambient.def.flight, time_step_};
  const AxisFactors factors = axisFactors(body);
  RowVelocity row = member.is_locked ? computeLockedVelocity(task, start, factors)
                                     : computeRowVelocity(task, start);
  if (ambient.surface()) {
    row.change_W.angular += start.orientation * by_surface.head<3>();
    row.change_W.linear += start.orientation * by_surface.tail<3>();
  }
  countLoads(ambient, row.count.load_evaluations);
  ambient.counters.guarded += row.count.guarded;
  if (!row.change_W.vector().allFinite()) {
    ++ambient.counters.rejected;
    bodies_.complaints.say(Complaint::kNotFinite);
    row.change_W = row.turning_W = row.isotropic_excess_W = {};
  }
  setExternalImpulse(solver_body, withoutTraces(row.change_W, time_step_));

  RowBody& row_body = row_bodies_->add(member.solver_body);
  row_body.start = start;
  row_body.turning_W = row.turning_W;
  row_body.extent = row.extent;
  row_body.is_held = member.is_held;
  row_body.inverse_inertia_T = body.getInvInertiaTensorWorld().transpose();
  row_body.inverse_mass = body.getInvMass();
  row_body.spin_change = solver_body.m_externalTorqueImpulse;
  row_body.velocity_change = solver_body.m_externalForceImpulse;
  row_body.spin_aside = toBullet(row.isotropic_excess_W.angular);
  row_body.velocity_aside = toBullet(row.isotropic_excess_W.linear);
  if (member.is_locked) {
    lock(row_body, ambient, factors, solver_body);
  } else {
    const Matrix3 R = start.orientation.toRotationMatrix();
    const bool is_diagonal = ambient.model.has_diagonal_inertia && !ambient.surface();
    row_body.has_coupling = !is_diagonal;
    row_body.basis = is_diagonal ? toWorld(Vector6(ambient.basis_B.diagonal()), R)
                                 : toWorld(basisOf(ambient), R);
  }
}

void SolverGroup::showPush(SolverBodies& solver_bodies, Push push) noexcept {
  for (const Member& member : members_) {
    const RowBody* row_body = row_bodies_->find(member.solver_body);
    if (!row_body) continue;
    btSolverBody& solver_body = solver_bodies[member.solver_body];
    solver_body.m_externalTorqueImpulse = row_body->spin_change;
    solver_body.m_externalForceImpulse = row_body->velocity_change;
    if (push == Push::kTrue) continue;
    solver_body.m_externalTorqueImpulse += row_body->spin_aside;
    solver_body.m_externalForceImpulse += row_body->velocity_aside;
  }
}

bool SolverGroup::holdsSlope(const SolverBodies& solver_bodies,
                             const btSolverConstraint& contact) const noexcept {
  const btVector3& normal =
      static_cast<const btManifoldPoint*>(contact.m_originalContactPoint)->m_normalWorldOnB;
  const btVector3 push = solver_bodies[contact.m_solverBodyIdA].m_externalForceImpulse -
                         solver_bodies[contact.m_solverBodyIdB].m_externalForceImpulse;
  if (!isHeldAslant(push, normal, contact.m_friction)) return false;
  for (const int id : {contact.m_solverBodyIdA, contact.m_solverBodyIdB}) {
    const Member* member = memberOf(id);
    if (member && turnsAside(*member->ambient, normal)) return true;
  }
  return false;
}

void SolverGroup::rewriteRows(SolverBodies& solver_bodies, const RowPools& rows,
                              const MultiBodyRows* multibodies,
                              const btContactSolverInfo& info) noexcept {
  const bool has_trees = multibodies && multibodies->trees;
  if (members_.empty() && !has_trees) return;
  if (multibodies && !members_.empty())
    prepareJoinedToMultiBodies(solver_bodies, multibodies->joints);
  if (row_bodies_->empty() && !has_trees) return;
  saveFeedbackJacobians(rows.joints);
  joint_gaps_->watch(rows.joints, *row_bodies_, solver_bodies);
  const auto rewrite = [&](btConstraintArray& pool, RowKind kind, btScalar relaxation) {
    ambient::rewriteRows(pool, kind, relaxation, *row_bodies_, solver_bodies);
  };
  rewrite(rows.contacts, RowKind::kContact, info.m_sor);
  rewrite(rows.frictions, RowKind::kFriction, info.m_sor);
  rewrite(rows.torsional_frictions, RowKind::kTorsionalFriction, 1);
  rewrite(rows.joints, RowKind::kJoint, 1);
  if (multibodies) rewriteMultiBodyRows(*multibodies, info, *row_bodies_, solver_bodies);
  reapplyWarmStart(solver_bodies, rows, multibodies, info.m_solverMode);
}

int SolverGroup::solveJoints(SolverBodies& solver_bodies, btConstraintArray& joints) noexcept {
  return joint_chains_->solve(joints, *row_bodies_, solver_bodies);
}

void SolverGroup::prepareJoinedToMultiBodies(SolverBodies& solver_bodies,
                                             const btMultiBodyConstraintArray& joints) noexcept {
  forEachJoinedBody(joints, [&](int id) {
    Member* member = memberOf(id);
    if (!member) return;
    if (!row_bodies_->find(id)) prepareForRows(*member, solver_bodies[id]);
    row_bodies_->find(id)->is_held = true;
  });
}

void SolverGroup::reapplyWarmStart(SolverBodies& solver_bodies, const RowPools& rows,
                                   const MultiBodyRows* multibodies, int solver_mode) noexcept {
  const bool for_multibodies = multibodies && (solver_mode & SOLVER_USE_ARTICULATED_WARMSTARTING);
  if (!(solver_mode & SOLVER_USE_WARMSTARTING) && !for_multibodies) return;
  for (const Member& member : members_) {
    if (member.solver_body == kAlone) continue;
    solver_bodies[member.solver_body].internalGetDeltaLinearVelocity().setZero();
    solver_bodies[member.solver_body].internalGetDeltaAngularVelocity().setZero();
  }
  reapplyImpulses(rows.contacts, *row_bodies_, solver_bodies);
  if (!for_multibodies) return;
  reapplyMultiBodyImpulses(multibodies->contacts, *row_bodies_, solver_bodies);
  reapplyMultiBodyImpulses(multibodies->frictions, *row_bodies_, solver_bodies);
  // Stock Bullet forgets the rigid side of these, and momentum is lost.
  reapplyMultiBodyImpulses(multibodies->joints, *row_bodies_, solver_bodies);
}

void SolverGroup::saveFeedbackJacobians(const btConstraintArray& joints) noexcept {
  for (int i = 0; i < joints.size(); ++i) {
    const btSolverConstraint& row = joints[i];
    const auto* constraint = static_cast<const btTypedConstraint*>(row.m_originalContactPoint);
    if (!constraint->getJointFeedback()) continue;
    saved_.push_back({i, row.m_relpos1CrossNormal, row.m_contactNormal1, row.m_relpos2CrossNormal,
                      row.m_contactNormal2});
  }
}

void SolverGroup::restoreFeedbackJacobians(btConstraintArray& joints) noexcept {
  for (const SavedJacobian& saved : saved_) {
    btSolverConstraint& row = joints[saved.row];
    row.m_relpos1CrossNormal = saved.angular_a;
    row.m_contactNormal1 = saved.linear_a;
    row.m_relpos2CrossNormal = saved.angular_b;
    row.m_contactNormal2 = saved.linear_b;
  }
  saved_.clear();
}

void SolverGroup::finish(SolverBodies& solver_bodies, btConstraintArray& joints) noexcept {
  joint_gaps_->measure(joints, *row_bodies_, solver_bodies, time_step_);
  restoreFeedbackJacobians(joints);
  if (is_held_)
    for (int i = 0; i < solver_bodies.size(); ++i) dropRows(solver_bodies[i]);
  for (const Member& member : members_) {
    if (member.solver_body == kAlone) {
      free_members_.push_back(&member);
      continue;
    }
    btSolverBody& solver_body = solver_bodies[member.solver_body];
    const RowBody* row_body = row_bodies_->find(member.solver_body);
    // Rows that are near have allowed the velocity that they were solved against; a flight with a
    // fast turn would take the body elsewhere.
    const bool may_fly = !row_body || (!member.is_locked && row_body->extent <= kSlowTurn);
    if (row_body) {
      member.ambient->counters.rows += row_body->rows;
      member.ambient->counters.joint_rows += row_body->joint_rows;
      noteGap(*member.ambient, *row_body);
    }
    if (may_fly && isUntouched(solver_body)) {
      free_members_.push_back(&member);
    } else {
      // Whatever can move a body was there when those with rows were found.
      AMBIENT_ASSERT(row_body);
      if (!finishRows(*member.ambient, *row_body, solver_body, time_step_))
        bodies_.complaints.say(Complaint::kNotFinite);
    }
  }
  flyFreely(solver_bodies);
  members_.clear();
}

// Flights touch nothing but their own body, so that any thread may compute them. Side by side they
// are quicker, but few bodies are better spread over the threads.
void SolverGroup::flyFreely(SolverBodies& solver_bodies) noexcept {
  constexpr int kLeastGroups = 8;
  const int count = static_cast<int>(free_members_.size());
  TaskRunner* runner = bodies_.task_runner;
  const int together =
      runner ? std::clamp(count / kLeastGroups, 1, kFlightsTogether) : kFlightsTogether;
  const auto fly = [&](int group) {
    const int first = group * together;
    flyTogether(first, std::min(together, count - first), solver_bodies);
  };
  const FlightTasks flights(fly);
  const int groups = (count + together - 1) / together;
  if (runner) {
    runner->runAll(flights, groups);
  } else {
    for (int i = 0; i < groups; ++i) flights.run(i);
  }
  for (const Member* member : free_members_) {
    const SubstepOutcome& outcome = member->ambient->outcome;
    if (outcome.kind != Outcome::kFlown) bodies_.complaints.say(Complaint::kNotFinite);
    if (outcome.flight.is_too_long) bodies_.complaints.sayTooLong(member->ambient->def);
  }
  free_members_.clear();
}

void SolverGroup::flyTogether(int first, int count, SolverBodies& solver_bodies) const noexcept {
  AmbientBody* bodies[kFlightsTogether] = {};
  Twist changes_W[kFlightsTogether];
  const Member* const* members = free_members_.data() + first;
  for (int i = 0; i < count; ++i) bodies[i] = members[i]->ambient;
  beginFlights(bodies, count, time_step_, changes_W);
  for (int i = 0; i < count; ++i) {
    const Member& member = *members[i];
    if (member.solver_body == kAlone) {
      addVelocity(*member.ambient->body, changes_W[i]);
    } else {
      setExternalImpulse(solver_bodies[member.solver_body], changes_W[i]);
    }
  }
}

const SolverGroup::Member* SolverGroup::memberOf(int solver_body) const noexcept {
  // Bodies appended after convertBodies (fixed, kinematic) are never ambient.
  if (static_cast<std::size_t>(solver_body) >= member_of_solver_body_.size()) return nullptr;
  const int index = member_of_solver_body_[solver_body];
  return index < 0 ? nullptr : &members_[index];
}

SolverGroup::Member* SolverGroup::memberOf(int solver_body) noexcept {
  return const_cast<Member*>(std::as_const(*this).memberOf(solver_body));
}

AMBIENT_END
