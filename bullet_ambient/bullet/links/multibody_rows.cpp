#include "bullet_ambient/bullet/links/multibody_rows.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/tree_state.h"

AMBIENT_BEGIN
namespace {

// One side of a row: a multibody (in fluid, if `tree` is set), an ambient body, another rigid body,
// or nothing (all pointers null).
struct MultiBodyRowSide {
  btMultiBody* multibody = nullptr;
  int jacobian = 0;  // index in m_jacobians at which the multibody's Jacobian begins
  int change = 0;    // index in m_deltaVelocities at which its velocity change begins
  AmbientTree* tree = nullptr;
  RowBody* ambient = nullptr;
  const btSolverBody* solver_body = nullptr;
  RowJacobian rigid;

  bool isInFluid() const { return tree || ambient; }
};

// Rows of multibodies of one group, and what is needed to rewrite them.
class RowSet {
 public:
  RowSet(const MultiBodyRows& rows, RowBodies& bodies,
         const btAlignedObjectArray<btSolverBody>& solver_bodies)
      : data_(rows.data), trees_(rows.trees), bodies_(bodies), solver_bodies_(solver_bodies) {}

  // Rewrites all rows of a pool. `time_step` [s]: Bullet has included the dry body's velocity
  // change by applied forces in this time; 0: it has included none.
  void rewrite(btMultiBodyConstraintArray& rows, btScalar relaxation, btScalar time_step) {
    for (int i = 0; i < rows.size(); ++i) {
      btMultiBodySolverConstraint& row = rows[i];
      const RowJacobian jacobian_a{row.m_relpos1CrossNormal, row.m_contactNormal1,
                                   row.m_angularComponentA};
      const RowJacobian jacobian_b{row.m_relpos2CrossNormal, row.m_contactNormal2,
                                   row.m_angularComponentB};
      const MultiBodyRowSide a = row.m_multiBodyA ? multibody(row.m_multiBodyA, row.m_jacAindex,
                                                              row.m_deltaVelAindex, jacobian_a)
                                                  : rigidBody(row.m_solverBodyIdA, jacobian_a);
      const MultiBodyRowSide b = row.m_multiBodyB ? multibody(row.m_multiBodyB, row.m_jacBindex,
                                                              row.m_deltaVelBindex, jacobian_b)
                                                  : rigidBody(row.m_solverBodyIdB, jacobian_b);
      if (!a.isInFluid() && !b.isInFluid()) continue;
      rewriteRow(row, a, b, relaxation, time_step);
      count(a.isInFluid() ? a : b);
    }
  }

 private:
  MultiBodyRowSide multibody(btMultiBody* body, int jacobian, int change,
                             const RowJacobian& rigid) const {
    AmbientTree* tree = trees_ ? trees_->find(body) : nullptr;
    if (tree && !isSolved(*tree)) tree = nullptr;
    return {body, jacobian, change, tree, nullptr, nullptr, rigid};
  }

  MultiBodyRowSide rigidBody(int id, const RowJacobian& rigid) {
    if (id < 0) return {nullptr, 0, 0, nullptr, nullptr, nullptr, rigid};
    return {nullptr, 0, 0, nullptr, bodies_.find(id), &solver_bodies_[id], rigid};
  }

  static void count(const MultiBodyRowSide& side) {
    if (side.tree) {
      ++side.tree->links.front()->ambient.counters.rows;
    } else {
      ++side.ambient->rows;
    }
  }

  // Replaces the response of a dry tree by H^-1 J^T. Warm starting has applied `impulse` with the
  // dry response: applies it with the difference, too.
  void respond(const MultiBodyRowSide& side, btScalar impulse) {
    TreeStep& step = side.tree->step;
    Coordinates &force = step.change, &response = step.spare;
    const int size = static_cast<int>(force.size());
    btScalar* stored = &data_.m_deltaVelocitiesUnitImpulse[side.jacobian];
    for (int i = 0; i < size; ++i)
      force[i] = static_cast<double>(data_.m_jacobians[side.jacobian + i]);
    if (step.outcome == Outcome::kFlown) side.tree->flight.prepareJointRows();
    side.tree->flight.dynamics().respond(force, response);
    for (int i = 0; i < size; ++i) {
      const btScalar change = static_cast<btScalar>(response[i]) - stored[i];
      stored[i] += change;
      if (impulse != 0) data_.m_deltaVelocities[side.change + i] += change * impulse;
      force[i] = static_cast<double>(change);
    }
    if (impulse == 0) return;
    force *= static_cast<double>(impulse);
    addChange(*side.multibody, force);
  }

  // Returns the response of one side to a unit impulse along its row, J H^-1 J^T or J' D J'^T;
  // brings an ambient body's side into its basis. `impulse`: that of warm starting.
  btScalar responseOf(const MultiBodyRowSide& side, btScalar impulse) {
    if (side.tree) respond(side, impulse);
    if (side.multibody) {
      btScalar sum = 0;
      for (int i = 0; i < side.multibody->getNumDofs() + 6; ++i)
        sum += data_.m_jacobians[side.jacobian + i] *
               data_.m_deltaVelocitiesUnitImpulse[side.jacobian + i];
      return sum;
    }
    if (side.ambient) return changeBasis(*side.ambient, side.rigid);
    return side.solver_body ? inverseEffectiveMass(*side.solver_body, side.rigid) : btScalar(0);
  }

  // Returns the velocity change along the row by forces and fluid, outside the rows, that the
  // right-hand side does not contain yet.
  static btScalar unseenChange(const MultiBodyRowSide& side, btScalar time_step) {
    if (!side.ambient) return 0;
    const RowJacobian& rigid = side.rigid;
    const btScalar change = rigid.angular.dot(side.ambient->spin_change) +
                            rigid.linear.dot(side.ambient->velocity_change);
    // Bullet includes no forces in rows about an axis, such as rolling friction.
    if (time_step == 0 || rigid.linear.length2() == 0) return change;
    const btRigidBody& body = *side.solver_body->m_originalBody;
    const btVector3 spin = body.getInvInertiaTensorWorld() * body.getTotalTorque();
    const btVector3 velocity = body.getTotalForce() * body.getInvMass();
    return change - time_step * (rigid.angular.dot(spin) + rigid.linear.dot(velocity));
  }

  static bool isLocked(const MultiBodyRowSide& side) {
    return side.ambient && side.ambient->is_locked;
  }

  // Switches off a row along locked axes only, whose other side is a multibody that cannot move.
  // Keeps the effective mass, by which the solver divides.
  static void suspendRow(btMultiBodySolverConstraint& row, const MultiBodyRowSide& a,
                         const MultiBodyRowSide& b) {
    for (const MultiBodyRowSide* side : {&a, &b}) {
      if (!side->ambient) continue;
      side->rigid.angular.setZero();
      side->rigid.linear.setZero();
      side->rigid.angular_component.setZero();
    }
    row.m_rhs = row.m_cfm = 0;
  }

  void rewriteRow(btMultiBodySolverConstraint& row, const MultiBodyRowSide& a,
                  const MultiBodyRowSide& b, btScalar relaxation, btScalar time_step) {
    const btScalar old_inverse = row.m_jacDiagABInv;
    const btScalar unseen = unseenChange(a, time_step) + unseenChange(b, time_step);
    const btScalar response =
        responseOf(a, row.m_appliedImpulse) + responseOf(b, row.m_appliedImpulse);
    if (!(old_inverse > 0)) return;  // switched off by Bullet
    const btScalar cfm = row.m_cfm / old_inverse;
    const btScalar old_response = relaxation / old_inverse - cfm;
    if ((isLocked(a) || isLocked(b)) && !(response > kNoResponse * old_response)) {
      suspendRow(row, a, b);
      return;
    }
    const btScalar new_inverse = relaxation / (response + cfm);
    row.m_rhs = (row.m_rhs / old_inverse - unseen) * new_inverse;
    row.m_cfm = cfm * new_inverse;
    row.m_jacDiagABInv = new_inverse;
  }

  btMultiBodyJacobianData& data_;
  const AmbientTrees* trees_;
  RowBodies& bodies_;
  const btAlignedObjectArray<btSolverBody>& solver_bodies_;
};

}  // namespace

void rewriteMultiBodyRows(const MultiBodyRows& rows, const btContactSolverInfo& info,
                          RowBodies& bodies,
                          const btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept {
  RowSet set(rows, bodies, solver_bodies);
  set.rewrite(rows.contacts, info.m_sor, info.m_timeStep);
  set.rewrite(rows.frictions, info.m_sor, info.m_timeStep);
  set.rewrite(rows.rolling_frictions, info.m_sor, 0);
  set.rewrite(rows.spinning_frictions, info.m_sor, 0);
  set.rewrite(rows.joints, 1, 0);
}

namespace {

using Row = btMultiBodySolverConstraint;

// One side of a row: a multibody, a rigid body, or nothing.
struct Side {
  btMultiBody* multibody;
  int jacobian, change;  // where those of the multibody begin
  btSolverBody* body;
  const btVector3 &angular, &linear, &angular_component;
};

// One friction row, its impulse, and the one that it asks for without a limit.
class FrictionRow {
 public:
  FrictionRow(const Row& row, btMultiBodyJacobianData& data,
              btAlignedObjectArray<btSolverBody>& solver_bodies)
      : row_(row),
        data_(data),
        sides_{{row.m_multiBodyA, row.m_jacAindex, row.m_deltaVelAindex,
                bodyAt(rigidBodyA(row), solver_bodies), row.m_relpos1CrossNormal,
                row.m_contactNormal1, row.m_angularComponentA},
               {row.m_multiBodyB, row.m_jacBindex, row.m_deltaVelBindex,
                bodyAt(rigidBodyB(row), solver_bodies), row.m_relpos2CrossNormal,
                row.m_contactNormal2, row.m_angularComponentB}} {
    wanted = row.m_appliedImpulse + row.m_rhs - row.m_appliedImpulse * row.m_cfm -
             (changeAlong(sides_[0]) + changeAlong(sides_[1])) * row.m_jacDiagABInv;
  }

  btScalar wanted;

  // Applies the impulse, at most `limit` either way. Returns the velocity along the row that it
  // changes.
  btScalar apply(btScalar limit) {
    const btScalar impulse = std::clamp(wanted, -limit, limit);
    const btScalar change = impulse - row_.m_appliedImpulse;
    row_.m_appliedImpulse = impulse;
    for (const Side& side : sides_) apply(side, change);
    return change / row_.m_jacDiagABInv;
  }

 private:
  static btSolverBody* bodyAt(int id, btAlignedObjectArray<btSolverBody>& bodies) {
    return id < 0 ? nullptr : &bodies[id];
  }

  btScalar changeAlong(const Side& side) const {
    btScalar sum = 0;
    if (side.multibody) {
      for (int i = 0; i < side.multibody->getNumDofs() + 6; ++i)
        sum += data_.m_jacobians[side.jacobian + i] * data_.m_deltaVelocities[side.change + i];
    } else if (side.body) {
      sum = side.linear.dot(side.body->internalGetDeltaLinearVelocity()) +
            side.angular.dot(side.body->internalGetDeltaAngularVelocity());
    }
    return sum;
  }

  void apply(const Side& side, btScalar impulse) {
    if (side.multibody) {
      const btScalar* response = &data_.m_deltaVelocitiesUnitImpulse[side.jacobian];
      for (int i = 0; i < side.multibody->getNumDofs() + 6; ++i)
        data_.m_deltaVelocities[side.change + i] += response[i] * impulse;
      side.multibody->applyDeltaVeeMultiDof2(response, impulse);
    } else if (side.body) {
      side.body->internalApplyImpulse(side.linear * side.body->internalGetInvMass(),
                                      side.angular_component, impulse);
    }
  }

  const Row& row_;
  btMultiBodyJacobianData& data_;
  const Side sides_[2];
};

}  // namespace

btScalar solveFrictionPair(const Row& first, const Row& second, btMultiBodyJacobianData& data,
                           btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept {
  FrictionRow a(first, data, solver_bodies), b(second, data, solver_bodies);
  btScalar most_a = SIMD_INFINITY, most_b = SIMD_INFINITY;
  const btScalar limit_a = std::abs(first.m_upperLimit);
  const btScalar limit_b = std::abs(second.m_upperLimit);
  const bool is_within = a.wanted * a.wanted + b.wanted * b.wanted < limit_a * limit_b;
  const btScalar largest = std::max(std::abs(a.wanted), std::abs(b.wanted));
  if (!is_within && largest > 0) {
    // Scaled: the squares of tiny numbers vanish.
    const btScalar x = std::abs(a.wanted) / largest, y = std::abs(b.wanted) / largest;
    const btScalar length = std::sqrt(x * x + y * y);
    most_a = limit_a * x / length;
    most_b = limit_b * y / length;
  }
  return a.apply(most_a) + b.apply(most_b);
}

AMBIENT_END
