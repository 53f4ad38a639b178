#include "bullet_ambient/bullet/solver/solver_group.h"

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>

#include <utility>

#include "bullet_ambient/bullet/links/multibody_rows.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/rows/joint_chains.h"
#include "bullet_ambient/bullet/rows/joint_gaps.h"
#include "bullet_ambient/bullet/rows/row_motion.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

AMBIENT_BEGIN

SolverGroup::SolverGroup(AmbientBodies& bodies)
    : bodies_(bodies),
      row_bodies_(std::make_unique<RowBodies>()),
      joint_chains_(std::make_unique<JointChains>()),
      joint_gaps_(std::make_unique<JointGaps>()) {}

SolverGroup::~SolverGroup() = default;

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

bool SolverGroup::hasMembers() const noexcept {
  return !row_bodies_->empty() || !bodies_.trees.empty();
}

bool SolverGroup::touchesMember(const btMultiBodySolverConstraint& row) const noexcept {
  const auto is_member = [this](const btMultiBody* multibody, int solver_body) {
    if (!multibody) return row_bodies_->find(solver_body) != nullptr;
    const AmbientTree* tree = bodies_.trees.find(multibody);
    return tree && isSolved(*tree);
  };
  return is_member(row.m_multiBodyA, row.m_solverBodyIdA) ||
         is_member(row.m_multiBodyB, row.m_solverBodyIdB);
}

int SolverGroup::solveJoints(SolverBodies& solver_bodies, btConstraintArray& joints) noexcept {
  return joint_chains_->solve(joints, *row_bodies_, solver_bodies);
}

void SolverGroup::reapplyWarmStart(SolverBodies& solver_bodies, const RowPools& rows,
                                   const MultiBodyRows* multibodies, int solver_mode) noexcept {
  const bool for_multibodies = multibodies && (solver_mode & SOLVER_USE_ARTICULATED_WARMSTARTING);
  if (!(solver_mode & SOLVER_USE_WARMSTARTING) && !for_multibodies) return;
  for (const Member& member : members_) {
    solver_bodies[member.solver_body].internalGetDeltaLinearVelocity().setZero();
    solver_bodies[member.solver_body].internalGetDeltaAngularVelocity().setZero();
  }
  reapplyImpulses(rows.contacts, *row_bodies_, solver_bodies);
  if (!for_multibodies) return;
  reapplyMultiBodyImpulses(multibodies->contacts, *row_bodies_, solver_bodies);
  reapplyMultiBodyImpulses(multibodies->frictions, *row_bodies_, solver_bodies);
  // Stock Bullet applies the impulses of joints to the multibody only, which loses momentum.
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
