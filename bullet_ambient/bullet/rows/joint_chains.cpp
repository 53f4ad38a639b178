#include "bullet_ambient/bullet/rows/joint_chains.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>

#include "bullet_ambient/bullet/rows/joint_gaps.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

AMBIENT_BEGIN

void JointChains::reserve(int solver_bodies) {
  const auto count = static_cast<std::size_t>(solver_bodies);
  bodies_.reserve(count + 1);
  queue_.reserve(count);
}

int JointChains::solve(btConstraintArray& joints, RowBodies& ambient,
                       SolverBodies& bodies) noexcept {
  if (ambient.empty() || joints.size() == 0) return 0;
  joints_ = &joints;
  ambient_ = &ambient;
  solver_bodies_ = &bodies;
  if (!linkBodies()) return 0;
  int solved = 0;
  // Goes through joints, whose order is that of the program. The order of solver bodies depends on
  // the order of contacts.
  for (int i = 0; i < joints.size(); ++i)
    for (const int id : {joints[i].m_solverBodyIdA, joints[i].m_solverBodyIdB})
      if (bodies_[id].is_ambient && !bodies_[id].is_visited) solved += solveChain(id);
  return solved;
}

// Solves the chain of joints around a body. Returns the number of rows solved; 0 for a loop, or if
// the factor fails.
int JointChains::solveChain(int root) noexcept {
  if (!gatherChain(root) || rows_.empty() || !factor_.begin()) return 0;
  fillMatrix();
  if (!factor_.factorize()) return 0;
  impulses_.assign((rows_.size() + 3) / 4 * 4, 0);
  for (std::size_t i = 0; i < rows_.size(); ++i)
    impulses_[i] = missingVelocity(static_cast<int>(i));
  factor_.solve(impulses_.data());
  return apply();
}

// Returns what the chains need to know of a solver body, before its rows are linked.
JointChains::Body JointChains::describe(int body) const noexcept {
  btSolverBody& solver_body = (*solver_bodies_)[body];
  const btRigidBody* original = solver_body.m_originalBody;
  const bool can_move = original && original->getInvMass() > 0;
  const RowBody* ambient = ambient_->find(body);
  Body described;
  described.is_ambient = ambient;
  if (!ambient && !can_move) return described;
  const btVector3 all(1, 1, 1);
  // Bullet has appended a body beyond ambient_'s after convertBodies(): if it can move, it is in
  // another group.
  const bool is_plain = ambient ? !ambient->is_locked
                                : static_cast<std::size_t>(body) < ambient_->size() &&
                                      solver_body.m_angularFactor == all &&
                                      solver_body.m_linearFactor == all;
  described.kind = is_plain ? Kind::kPlain : Kind::kOther;
  described.change = pairsOf(solver_body.internalGetDeltaAngularVelocity(),
                             solver_body.internalGetDeltaLinearVelocity());
  return described;
}

// Links the rows without bounds of each body that can move, from the last to the first. Returns
// false if there are none.
bool JointChains::linkBodies() noexcept {
  bodies_.clear();
  for (int i = 0; i < solver_bodies_->size(); ++i) bodies_.push_back(describe(i));
  const std::size_t ends = 2 * static_cast<std::size_t>(joints_->size());
  if (sides_.size() < ends) sides_.resize(ends);
  next_end_.resize(ends);
  bool is_any = false;
  for (int i = 0; i < joints_->size(); ++i) {
    const btSolverConstraint& row = (*joints_)[i];
    Body &a = bodies_[row.m_solverBodyIdA], &b = bodies_[row.m_solverBodyIdB];
    if (a.kind == Kind::kOther || b.kind == Kind::kOther || hasBounds(row) ||
        !(row.m_jacDiagABInv > 0))
      continue;
    is_any = true;
    int end = 2 * i;
    for (Body* body : {&a, &b}) {
      if (body->kind == Kind::kPlain) {
        next_end_[end] = body->end;
        body->end = end;
      }
      ++end;
    }
  }
  return is_any;
}

// Collects the rows of the chain that contains `root`, breadth first. Returns false if joints make
// a loop. All bodies that cannot move count as one body of a loop.
bool JointChains::gatherChain(int root) noexcept {
  const btTypedConstraint* anchor = nullptr;
  bool is_open = true;
  rows_.clear();
  factor_.clear();
  queue_.assign(1, root);
  bodies_[root].is_visited = true;
  for (std::size_t next = 0; next < queue_.size(); ++next) {
    const Body& body = bodies_[queue_[next]];
    for (int end = body.end; end >= 0; end = next_end_[end]) {
      const btSolverConstraint& row = (*joints_)[end / 2];
      const btTypedConstraint* joint = jointOf(row);
      if (joint == body.entered_by) continue;  // its rows were added at its other body
      const int other_id = end % 2 == 0 ? row.m_solverBodyIdB : row.m_solverBodyIdA;
      Body& other = bodies_[other_id];
      if (other.kind == Kind::kFixed) {
        is_open = is_open && (!anchor || anchor == joint);
        anchor = joint;
      } else if (!other.is_visited) {
        other.is_visited = true;
        other.entered_by = joint;
        queue_.push_back(other_id);
      } else {
        is_open = is_open && other.entered_by == joint;
      }
      if (is_open) addRow(end / 2);
    }
  }
  return is_open;
}

// Sets a side of the row that addRow() appends. Returns the first row of the chain at the body; the
// row itself if the body cannot move.
int JointChains::addSide(Side& side, int id, const btVector3& angular, const btVector3& linear,
                         const btVector3& angular_component) noexcept {
  const auto number = static_cast<int>(rows_.size());
  Body& body = bodies_[id];
  side.body = body.kind == Kind::kFixed ? -1 : id;
  if (side.body < 0) return number;
  side.before = body.side;
  body.side = static_cast<int>(&side - sides_.data());
  if (body.first_row < 0) body.first_row = number;
  const auto inverse_mass = static_cast<double>((*solver_bodies_)[id].internalGetInvMass().x());
  const DoublePair masses = {1, inverse_mass};
  const DoublePairs response = pairsOf(angular_component, linear);
  side.jacobian = pairsOf(angular, linear);
  side.response = {masses * response.x, masses * response.y, masses * response.z};
  return body.first_row;
}

// Appends a row of the pool to the chain.
void JointChains::addRow(int index) noexcept {
  const btSolverConstraint& row = (*joints_)[index];
  Side* sides = sides_.data() + 2 * rows_.size();
  const int first_a = addSide(sides[0], row.m_solverBodyIdA, row.m_relpos1CrossNormal,
                              row.m_contactNormal1, row.m_angularComponentA);
  const int first_b = addSide(sides[1], row.m_solverBodyIdB, row.m_relpos2CrossNormal,
                              row.m_contactNormal2, row.m_angularComponentB);
  factor_.addRow(std::min(first_a, first_b));
  rows_.push_back(index);
}

// Fills the matrix J K^-1 J^T + c / j.
void JointChains::fillMatrix() noexcept {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const auto number = static_cast<int>(i);
    const btSolverConstraint& constraint = (*joints_)[rows_[i]];
    const ChainFactor::Row row = factor_.row(number);
    for (const Side* side : {&sides_[2 * i], &sides_[2 * i + 1]}) {
      if (side->body < 0) continue;
      const DoublePairs jacobian = side->jacobian;
      row[number] += product(jacobian, side->response);
      for (int other = side->before; other >= 0; other = sides_[other].before)
        row[other / 2] += product(jacobian, sides_[other].response);
    }
    row[number] += static_cast<double>(constraint.m_cfm / constraint.m_jacDiagABInv);
  }
}

// Returns rhs / j - J du of a row of the chain: the velocity change along it that its impulses
// still have to make [m/s].
double JointChains::missingVelocity(int row) const noexcept {
  const btSolverConstraint& constraint = (*joints_)[rows_[row]];
  auto velocity = static_cast<double>(constraint.m_rhs / constraint.m_jacDiagABInv);
  for (const Side* side : {&sides_[2 * row], &sides_[2 * row + 1]})
    if (side->body >= 0) velocity -= product(side->jacobian, bodies_[side->body].change);
  return velocity;
}

// Sets the impulses of the rows within their bounds, and applies them. Returns the number of rows;
// 0, without effect, if an impulse is not finite.
int JointChains::apply() noexcept {
  const auto count = static_cast<int>(rows_.size());
  for (const double impulse : impulses_)
    if (!std::isfinite(impulse)) return 0;
  for (int i = 0; i < count; ++i) {
    btSolverConstraint& row = (*joints_)[rows_[i]];
    const btScalar impulse =
        btClamped(static_cast<btScalar>(impulses_[i]), row.m_lowerLimit, row.m_upperLimit);
    row.m_appliedImpulse = impulse;
    btSolverBody &a = (*solver_bodies_)[row.m_solverBodyIdA],
                 &b = (*solver_bodies_)[row.m_solverBodyIdB];
    applyImpulse(a, row.m_contactNormal1, row.m_angularComponentA, impulse);
    applyImpulse(b, row.m_contactNormal2, row.m_angularComponentB, impulse);
    RowBody* ambient = ambient_->find(row.m_solverBodyIdA);
    if (!ambient) ambient = ambient_->find(row.m_solverBodyIdB);
    if (ambient) ++ambient->joint_rows;
  }
  return count;
}

AMBIENT_END
