#include "bullet_ambient/bullet/rows/joint_rows.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btScalar.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/four_numbers.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"

AMBIENT_BEGIN
namespace {

using SolverBodies = btAlignedObjectArray<btSolverBody>;

// Returns the velocity of Bullet's position correction [m/s]: the right-hand side plus the velocity
// along the row before the impulses of the step, with the change by external forces. Returns 0 for
// a row with bounds, which may be a motor with its speed in the right-hand side.
double correctionOf(btSolverConstraint& row, const SolverBodies& bodies) {
  if (hasBounds(row) || !(row.m_jacDiagABInv > 0)) return 0;
  const auto [a, b] = sidesOf(row);
  const auto velocityAt = [&](const RowSide& side) {
    const btSolverBody& body = bodies[side.solver_body];
    return side.rigid.along(body.m_linearVelocity + body.m_externalForceImpulse,
                            body.m_angularVelocity + body.m_externalTorqueImpulse);
  };
  return std::abs(
      static_cast<double>(row.m_rhs / row.m_jacDiagABInv + velocityAt(a) + velocityAt(b)));
}

// Returns the difference between the velocity that the row asks for and the one reached [m/s]; 0 if
// the impulse is at a bound.
double missedBy(btSolverConstraint& row, const SolverBodies& bodies) {
  const btScalar impulse = row.m_appliedImpulse;
  const bool is_bound = impulse <= row.m_lowerLimit || impulse >= row.m_upperLimit;
  if (is_bound || !(row.m_jacDiagABInv > 0)) return 0;
  const auto [a, b] = sidesOf(row);
  const auto changeAt = [&](const RowSide& side) {
    const btSolverBody& body = bodies[side.solver_body];
    return side.rigid.along(body.m_deltaLinearVelocity, body.m_deltaAngularVelocity);
  };
  const btScalar wanted = (row.m_rhs - impulse * row.m_cfm) / row.m_jacDiagABInv;
  return std::abs(static_cast<double>(wanted - changeAt(a) - changeAt(b)));
}

}  // namespace

void JointErrors::watch(const RowPools& pools, RowBodies& ambient) noexcept {
  rows_.clear();
  for (int i = 0; i < pools.joints.size(); ++i) {
    btSolverConstraint& row = pools.joints[i];
    const bool is_shift = !row.m_contactNormal1.isZero() || !row.m_contactNormal2.isZero();
    if (is_shift && (ambient.find(row.m_solverBodyIdA) || ambient.find(row.m_solverBodyIdB)))
      rows_.push_back({i, correctionOf(row, pools.solver_bodies)});
  }
}

void JointErrors::measure(const RowPools& pools, RowBodies& ambient,
                          double time_step) const noexcept {
  if (ambient.empty()) return;
  AMBIENT_ASSERT(time_step > 0);
  for (const Row& watched : rows_) {
    btSolverConstraint& row = pools.joints[watched.index];
    const int a = row.m_solverBodyIdA, b = row.m_solverBodyIdB;
    const double joint_error =
        time_step * std::max(watched.correction, missedBy(row, pools.solver_bodies));
    for (const int id : {a, b}) {
      RowBody* body = ambient.find(id);
      if (body && joint_error > body->joint_error) {
        body->joint_error = joint_error;
        body->joined_to = id == a ? b : a;
      }
    }
  }
}

namespace {

// Pivot relative to the diagonal entry of its row, below which it is rounding: the row depends on
// those before it.
constexpr double kNoPivot = 64 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());

// Most multiplications per row for the factor. Chains with dozens of joints on one body exceed it,
// and are left to the iterations.
constexpr double kMostWork = 1e4;

using Group = ChainFactor::Group;

// Entries of four rows in one column. By reference, as without AVX a compiler has no agreed way to
// return them.
using Lanes = double __attribute__((vector_size(32)));
AMBIENT_INLINE void loadLanes(Lanes& lanes, const double* at) {
  __builtin_memcpy(&lanes, at, sizeof lanes);
}
AMBIENT_INLINE void storeLanes(double* at, const Lanes& lanes) {
  __builtin_memcpy(at, &lanes, sizeof lanes);
}

// Subtracts `count` columns of four rows, each times its factor, from a sum, one after the other.
// `stride`: from factor to factor.
AMBIENT_INLINE void subtract(Lanes& sum, const double* columns, const double* factors, int stride,
                             int count) {
  for (int k = 0; k < count; ++k) {
    Lanes column;
    loadLanes(column, columns + 4 * k);
    sum -= column * factors[stride * k];
  }
}

// Computes L of four rows in the columns of all rows before them.
AMBIENT_INLINE void reduceLeft(const Group* groups, double* elements, int number) {
  const Group& group = groups[number];
  double* columns = elements + group.at - 4 * group.first;
  for (int earlier = group.first / 4; earlier < number; ++earlier) {
    const Group& other = groups[earlier];
    const double* of_others = elements + other.at - 4 * other.first;
    const int first = std::max(group.first, other.first);
    for (int j = std::max(group.first, 4 * earlier); j < 4 * earlier + 4; ++j) {
      const double* L_j = of_others + j % 4;
      Lanes sum;
      loadLanes(sum, columns + 4 * j);
      subtract(sum, columns + 4 * first, L_j + 4 * first, 4, j - first);
      storeLanes(columns + 4 * j, sum * L_j[4 * j]);
    }
  }
}

// Computes L of `count` of four rows in their own columns. Returns false if a row depends on those
// before it. Entries above the diagonal are not used.
AMBIENT_INLINE bool reduceOwn(const Group& group, double* elements, int number, int count) {
  double* columns = elements + group.at;
  const int before = 4 * number - group.first;
  for (int row = 0; row < count; ++row) {
    double* own = columns + 4 * (before + row);
    Lanes sum;
    loadLanes(sum, own);
    subtract(sum, columns, columns + row, 4, before + row);
    const double rest = sum[row];
    if (!(rest > kNoPivot * own[row])) return false;
    const double inverse = 1 / std::sqrt(rest);
    storeLanes(own, sum * inverse);
    own[row] = inverse;
  }
  return true;
}

AMBIENT_INLINE bool factorizeAll(const Group* groups, double* elements, int size) {
  for (int number = 0; 4 * number < size; ++number) {
    reduceLeft(groups, elements, number);
    if (!reduceOwn(groups[number], elements, number, std::min(4, size - 4 * number))) return false;
  }
  return true;
}

// Solves L y = x for four rows, y in place of x.
AMBIENT_INLINE void forward(const Group& group, const double* elements, int number, double* x) {
  const double* columns = elements + group.at;
  double* own = x + 4 * number;
  const int before = 4 * number - group.first;
  Lanes sum;
  loadLanes(sum, own);
  subtract(sum, columns, x + group.first, 1, before);
  storeLanes(own, sum);
  columns += 4 * before;
  for (int row = 0; row < 4; ++row) {
    for (int j = 0; j < row; ++j) own[row] -= columns[4 * j + row] * own[j];
    own[row] *= columns[4 * row + row];
  }
}

// Solves L^T s = y for four rows, s in place of y, and takes their share from the rows before.
AMBIENT_INLINE void backward(const Group& group, const double* elements, int number, double* x) {
  const double* columns = elements + group.at;
  double* own = x + 4 * number;
  const int before = 4 * number - group.first;
  const double* own_columns = columns + 4 * before;
  for (int row = 3; row >= 0; --row) {
    own[row] *= own_columns[4 * row + row];
    for (int j = 0; j < row; ++j) own[j] -= own_columns[4 * j + row] * own[row];
  }
  Lanes found;
  loadLanes(found, own);
  for (int j = 0; j < before; ++j) {
    Lanes change;
    loadLanes(change, columns + 4 * j);
    change *= found;
    double& sum = x[group.first + j];
    sum = (((sum - change[3]) - change[2]) - change[1]) - change[0];
  }
}

AMBIENT_INLINE void solveAll(const Group* groups, const double* elements, int size, double* x) {
  const int count = (size + 3) / 4;
  for (int number = 0; number < count; ++number) forward(groups[number], elements, number, x);
  for (int number = count - 1; number >= 0; --number) backward(groups[number], elements, number, x);
}

}  // namespace

void ChainFactor::clear() {
  size_ = 0;
  work_ = 0;
  groups_.clear();
}

void ChainFactor::addRow(int first) {
  if (size_ % 4 == 0) groups_.push_back({first, 0});
  groups_.back().first = std::min(groups_.back().first, first);
  ++size_;
  const double width = size_ - first;
  work_ += width * width;
}

bool ChainFactor::begin() {
  if (work_ > kMostWork * size_) return false;
  std::size_t count = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    groups_[i].at = count;
    count += 4 * (4 * (i + 1) - static_cast<std::size_t>(groups_[i].first));
  }
  elements_.assign(count, 0);
  return true;
}

bool ChainFactor::factorize() noexcept {
  static const auto factorize_all = fastestCopy<&factorizeAll>();
  return factorize_all(groups_.data(), elements_.data(), size_);
}

void ChainFactor::solve(double* x) const noexcept {
  static const auto solve_all = fastestCopy<&solveAll>();
  solve_all(groups_.data(), elements_.data(), size_, x);
}

void JointChains::reserve(int solver_bodies) {
  const auto count = static_cast<std::size_t>(solver_bodies);
  bodies_.reserve(count + 1);
  queue_.reserve(count);
}

int JointChains::solve(const RowPools& pools, RowBodies& ambient) noexcept {
  const btConstraintArray& joints = pools.joints;
  if (ambient.empty() || joints.size() == 0) return 0;
  joints_ = &pools.joints;
  ambient_ = &ambient;
  solver_bodies_ = &pools.solver_bodies;
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
      const btTypedConstraint* joint = constraintOf(row);
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
