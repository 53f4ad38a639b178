#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"

AMBIENT_BEGIN
namespace {

using Row = btMultiBodySolverConstraint;

// One side of a row, and the tree that moves in a fluid or the ambient body there; null: none.
struct FluidSide {
  const RowSide& at;
  AmbientTree* tree;
  RowBody* ambient;

  bool isInFluid() const { return tree || ambient; }
  bool isLocked() const { return ambient && ambient->is_locked; }
};

// Replaces the response of a dry tree by H^-1 J^T. Warm starting has applied `impulse` with the
// dry response: applies it with the difference, too.
void respond(const FluidSide& side, btScalar impulse, btMultiBodyJacobianData& data) {
  TreeStep& step = side.tree->step;
  Coordinates &force = step.change, &response = step.spare;
  const int size = static_cast<int>(force.size());
  btScalar* stored = &data.m_deltaVelocitiesUnitImpulse[side.at.jacobian];
  for (int i = 0; i < size; ++i)
    force[i] = static_cast<double>(data.m_jacobians[side.at.jacobian + i]);
  if (step.outcome == Outcome::kFlown) side.tree->flight.prepareJointRows();
  side.tree->flight.dynamics().respond(force, response);
  for (int i = 0; i < size; ++i) {
    const btScalar change = static_cast<btScalar>(response[i]) - stored[i];
    stored[i] += change;
    if (impulse != 0) data.m_deltaVelocities[side.at.change + i] += change * impulse;
    force[i] = static_cast<double>(change);
  }
  if (impulse == 0) return;
  force *= static_cast<double>(impulse);
  addChange(*side.at.multibody, force);
}

// Returns the response of one side to a unit impulse along its row, J H^-1 J^T or J' D J'^T;
// brings an ambient body's side into its basis. `impulse`: that of warm starting.
btScalar responseOf(const FluidSide& side, btScalar impulse, const RowPools& rows) {
  btMultiBodyJacobianData& data = rows.multibodies->data;
  if (side.tree) respond(side, impulse, data);
  if (side.at.multibody)
    return side.at.along(
        data, [&](int i) { return data.m_deltaVelocitiesUnitImpulse[side.at.jacobian + i]; });
  if (side.ambient) return changeBasis(*side.ambient, side.at.rigid);
  if (side.at.solver_body < 0) return 0;
  return inverseEffectiveMass(rows.solver_bodies[side.at.solver_body], side.at.rigid);
}

// Returns the velocity change along the row by forces and fluid, outside the rows, that the
// right-hand side does not contain yet.
btScalar unseenChange(const FluidSide& side, btScalar time_step, const RowPools& rows) {
  if (!side.ambient) return 0;
  const RowJacobian& rigid = side.at.rigid;
  const btScalar change = rigid.angular.dot(side.ambient->spin_change) +
                          rigid.linear.dot(side.ambient->velocity_change);
  // Bullet includes no forces in rows about an axis, such as rolling friction.
  if (time_step == 0 || rigid.linear.length2() == 0) return change;
  const btRigidBody& body = *rows.solver_bodies[side.at.solver_body].m_originalBody;
  const btVector3 spin = body.getInvInertiaTensorWorld() * body.getTotalTorque();
  const btVector3 velocity = body.getTotalForce() * body.getInvMass();
  return change - time_step * (rigid.angular.dot(spin) + rigid.linear.dot(velocity));
}

// Switches off a row along locked axes only, whose other side is a multibody that cannot move.
// Keeps the effective mass, by which the solver divides.
void suspendRow(Row& row, const FluidSide& a, const FluidSide& b) {
  for (const FluidSide* side : {&a, &b}) {
    if (!side->ambient) continue;
    side->at.rigid.angular.setZero();
    side->at.rigid.linear.setZero();
    side->at.rigid.angular_component.setZero();
  }
  row.m_rhs = row.m_cfm = 0;
}

// Rewrites a row. `time_step` [s]: Bullet has included the dry body's velocity change by applied
// forces in this time; 0: it has included none.
void rewriteRow(Row& row, const FluidSide& a, const FluidSide& b, btScalar relaxation,
                btScalar time_step, const RowPools& rows) {
  const btScalar old_inverse = row.m_jacDiagABInv;
  const btScalar unseen = unseenChange(a, time_step, rows) + unseenChange(b, time_step, rows);
  const btScalar response =
      responseOf(a, row.m_appliedImpulse, rows) + responseOf(b, row.m_appliedImpulse, rows);
  if (!(old_inverse > 0)) return;  // switched off by Bullet
  const btScalar cfm = row.m_cfm / old_inverse;
  const btScalar old_response = relaxation / old_inverse - cfm;
  if ((a.isLocked() || b.isLocked()) && !(response > kNoResponse * old_response)) {
    suspendRow(row, a, b);
    return;
  }
  const btScalar new_inverse = relaxation / (response + cfm);
  row.m_rhs = (row.m_rhs / old_inverse - unseen) * new_inverse;
  row.m_cfm = cfm * new_inverse;
  row.m_jacDiagABInv = new_inverse;
}

}  // namespace

void rewriteMultiBodyRows(const RowPools& rows, const btContactSolverInfo& info,
                          const AmbientTrees& trees, RowBodies& bodies) noexcept {
  const auto rewrite = [&](btMultiBodyConstraintArray& pool, btScalar relaxation,
                           btScalar time_step) {
    for (int i = 0; i < pool.size(); ++i) {
      const auto [of_a, of_b] = sidesOf(pool[i]);
      const FluidSide a{of_a, trees.findSolved(of_a.multibody), bodies.find(of_a.solver_body)};
      const FluidSide b{of_b, trees.findSolved(of_b.multibody), bodies.find(of_b.solver_body)};
      if (!a.isInFluid() && !b.isInFluid()) continue;
      rewriteRow(pool[i], a, b, relaxation, time_step, rows);
      const FluidSide& counted = a.isInFluid() ? a : b;
      if (counted.tree)
        ++counted.tree->links.front()->ambient.counters.rows;
      else
        ++counted.ambient->rows;
    }
  };
  rewrite(rows.multibodies->contacts, info.m_sor, info.m_timeStep);
  rewrite(rows.multibodies->frictions, info.m_sor, info.m_timeStep);
  rewrite(rows.multibodies->rolling_frictions, info.m_sor, 0);
  rewrite(rows.multibodies->spinning_frictions, info.m_sor, 0);
  rewrite(rows.multibodies->joints, 1, 0);
}

namespace {

using SolverBodies = btAlignedObjectArray<btSolverBody>;

using Sides = std::array<RowSide, 2>;

// Returns the impulse that a friction row asks for without a limit.
btScalar wantedImpulse(const Row& row, const Sides& sides, const btMultiBodyJacobianData& data,
                       const SolverBodies& bodies) {
  const auto changeAlong = [&](const RowSide& side) -> btScalar {
    if (side.multibody)
      return side.along(data, [&](int k) { return data.m_deltaVelocities[side.change + k]; });
    if (side.solver_body < 0) return 0;
    const btSolverBody& body = bodies[side.solver_body];
    return side.rigid.along(body.m_deltaLinearVelocity, body.m_deltaAngularVelocity);
  };
  return row.m_appliedImpulse + row.m_rhs - row.m_appliedImpulse * row.m_cfm -
         (changeAlong(sides[0]) + changeAlong(sides[1])) * row.m_jacDiagABInv;
}

// Applies the impulse of a friction row, at most `limit` either way. Returns the velocity along the
// row that it changes.
btScalar applyFriction(const Row& row, const Sides& sides, btScalar wanted, btScalar limit,
                       btMultiBodyJacobianData& data, SolverBodies& bodies) {
  const btScalar impulse = std::clamp(wanted, -limit, limit);
  const btScalar change = impulse - row.m_appliedImpulse;
  row.m_appliedImpulse = impulse;
  for (const RowSide& side : sides) {
    if (side.multibody) {
      const btScalar* response = &data.m_deltaVelocitiesUnitImpulse[side.jacobian];
      for (int i = 0; i < side.multibody->getNumDofs() + 6; ++i)
        data.m_deltaVelocities[side.change + i] += response[i] * change;
      side.multibody->applyDeltaVeeMultiDof2(response, change);
    } else if (side.solver_body >= 0) {
      btSolverBody& body = bodies[side.solver_body];
      body.internalApplyImpulse(side.rigid.linear * body.internalGetInvMass(),
                                side.rigid.angular_component, change);
    }
  }
  return change / row.m_jacDiagABInv;
}

}  // namespace

btScalar solveFrictionPair(Row& first, Row& second, btMultiBodyJacobianData& data,
                           SolverBodies& solver_bodies) noexcept {
  const Sides of_first = sidesOf(first), of_second = sidesOf(second);
  const btScalar a = wantedImpulse(first, of_first, data, solver_bodies);
  const btScalar b = wantedImpulse(second, of_second, data, solver_bodies);
  btScalar most_a = SIMD_INFINITY, most_b = SIMD_INFINITY;
  const btScalar limit_a = std::abs(first.m_upperLimit);
  const btScalar limit_b = std::abs(second.m_upperLimit);
  const bool is_within = a * a + b * b < limit_a * limit_b;
  const btScalar largest = std::max(std::abs(a), std::abs(b));
  if (!is_within && largest > 0) {
    // Scaled: the squares of tiny numbers vanish.
    const btScalar x = std::abs(a) / largest, y = std::abs(b) / largest;
    const btScalar length = std::sqrt(x * x + y * y);
    most_a = limit_a * x / length;
    most_b = limit_b * y / length;
  }
  const btScalar changed = applyFriction(first, of_first, a, most_a, data, solver_bodies);
  return changed + applyFriction(second, of_second, b, most_b, data, solver_bodies);
}

AMBIENT_END
