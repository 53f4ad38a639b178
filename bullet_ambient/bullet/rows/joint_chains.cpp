#include "bullet_ambient/bullet/rows/joint_chains.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/rows/joint_row.h"

AMBIENT_BEGIN
namespace {

// Pivot relative to the diagonal entry of its row, below which it is rounding: the row depends on
// those before it.
constexpr double kNoPivot = 64 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());

// Most multiplications per row for the factor. Chains with dozens of joints on one body exceed it,
// and are left to the iterations.
constexpr double kMostWork = 1e4;

}  // namespace

void JointChains::reserve(int solver_bodies) {
  const auto count = static_cast<std::size_t>(solver_bodies);
  first_link_.reserve(count + 1);
  entered_by_.reserve(count);
  is_visited_.reserve(count);
  first_row_.reserve(count);
  queue_.reserve(count);
}

int JointChains::solve(btConstraintArray& joints, RowBodies& ambient,
                       SolverBodies& bodies) noexcept {
  if (ambient.empty() || joints.size() == 0) return 0;
  joints_ = &joints;
  ambient_ = &ambient;
  bodies_ = &bodies;
  linkBodies();
  if (links_.empty()) return 0;
  entered_by_.assign(ambient.size(), nullptr);
  is_visited_.assign(ambient.size(), false);
  first_row_.assign(ambient.size(), -1);
  int solved = 0;
  // Goes through joints, whose order is that of the program. The order of solver bodies depends on
  // the order of contacts.
  for (int i = 0; i < joints.size(); ++i)
    for (const int body : {joints[i].m_solverBodyIdA, joints[i].m_solverBodyIdB})
      if (ambient.find(body) && !is_visited_[body]) solved += solveChain(body);
  return solved;
}

// Solves the chain of joints around a body. Returns the number of rows solved; 0 for a loop, or if
// the factor fails.
int JointChains::solveChain(int root) noexcept {
  if (!gatherChain(root) || !factorize()) return 0;
  substitute();
  return apply();
}

bool JointChains::canMove(int body) const noexcept {
  const btRigidBody* original = (*bodies_)[body].m_originalBody;
  return original && original->getInvMass() > 0;
}

// True if the response of a body is symmetric and the same in all its rows: no locked axes, and not
// a moving body of another group.
bool JointChains::isPlain(int body) const noexcept {
  const RowBody* ambient = ambient_->find(body);
  if (ambient) return !ambient->is_locked;
  // Bullet has appended this body after convertBodies(): if it can move, it is in another group.
  if (static_cast<std::size_t>(body) >= ambient_->size()) return !canMove(body);
  const btSolverBody& solver_body = (*bodies_)[body];
  const btVector3 all(1, 1, 1);
  return !canMove(body) ||
         (solver_body.m_angularFactor == all && solver_body.m_linearFactor == all);
}

int JointChains::otherBody(int row, int body) const noexcept {
  const btSolverConstraint& r = (*joints_)[row];
  return r.m_solverBodyIdA == body ? r.m_solverBodyIdB : r.m_solverBodyIdA;
}

// Lists the rows without bounds of each body that can move, in links_.
void JointChains::linkBodies() noexcept {
  first_link_.assign(ambient_->size() + 1, 0);
  const auto forEachEnd = [&](const auto& visit) {
    for (int i = 0; i < joints_->size(); ++i) {
      const btSolverConstraint& row = (*joints_)[i];
      const int a = row.m_solverBodyIdA, b = row.m_solverBodyIdB;
      if (hasBounds(row) || !(row.m_jacDiagABInv > 0) || !isPlain(a) || !isPlain(b)) continue;
      if (canMove(a)) visit(a, i);
      if (canMove(b)) visit(b, i);
    }
  };
  forEachEnd([&](int body, int) { ++first_link_[body]; });
  int sum = 0;
  for (int& first : first_link_) first = sum += first;
  links_.resize(static_cast<std::size_t>(sum));
  forEachEnd([&](int body, int row) { links_[--first_link_[body]] = row; });
}

// Collects the rows of the chain that contains `root`, breadth first. Returns false if joints make
// a loop. All bodies that cannot move count as one body of a loop.
bool JointChains::gatherChain(int root) noexcept {
  const btTypedConstraint* anchor = nullptr;
  bool is_open = true;
  rows_.clear();
  queue_.assign(1, root);
  is_visited_[root] = true;
  for (std::size_t next = 0; next < queue_.size(); ++next) {
    const int body = queue_[next];
    for (int i = first_link_[body]; i < first_link_[body + 1]; ++i) {
      const btTypedConstraint* joint = jointOf((*joints_)[links_[i]]);
      if (joint == entered_by_[body]) continue;  // its rows were added at its other body
      const int other = otherBody(links_[i], body);
      if (!canMove(other)) {
        is_open = is_open && (!anchor || anchor == joint);
        anchor = joint;
      } else if (!is_visited_[other]) {
        is_visited_[other] = true;
        entered_by_[other] = joint;
        queue_.push_back(other);
      } else {
        is_open = is_open && entered_by_[other] == joint;
      }
      if (is_open) addRow(links_[i]);
    }
  }
  return is_open;
}

JointChains::Side JointChains::sideOf(int body, const btVector3& angular, const btVector3& linear,
                                      const btVector3& angular_component) const noexcept {
  if (!canMove(body)) return {-1, {}, {}, {}, {}};
  const auto inverse_mass = static_cast<double>((*bodies_)[body].internalGetInvMass().x());
  return {body, toVector3(angular), toVector3(linear), toVector3(angular_component),
          inverse_mass * toVector3(linear)};
}

// Appends a row of the pool to the chain.
void JointChains::addRow(int index) noexcept {
  const btSolverConstraint& row = (*joints_)[index];
  const auto number = static_cast<int>(rows_.size());
  Row added{index,
            number,
            0,
            {sideOf(row.m_solverBodyIdA, row.m_relpos1CrossNormal, row.m_contactNormal1,
                    row.m_angularComponentA),
             sideOf(row.m_solverBodyIdB, row.m_relpos2CrossNormal, row.m_contactNormal2,
                    row.m_angularComponentB)}};
  for (const Side& side : added.sides) {
    if (side.body < 0) continue;
    int& first = first_row_[side.body];
    if (first < 0) first = number;
    added.first = std::min(added.first, first);
  }
  rows_.push_back(added);
}

// Computes the factor. Returns false if it would cost too much, or if the rows depend on each
// other.
bool JointChains::factorize() noexcept {
  std::size_t size = 0;
  double work = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::size_t width = i + 1 - static_cast<std::size_t>(rows_[i].first);
    rows_[i].at = size;
    size += width;
    work += static_cast<double>(width * width);
  }
  if (work > kMostWork * static_cast<double>(rows_.size())) return false;
  factor_.resize(size);
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (!reduceRow(static_cast<int>(i))) return false;
  return true;
}

// Computes row i of L in J K^-1 J^T + c / j = L L^T; stores the inverse of the diagonal entry.
// Returns false if the row depends on those before it.
bool JointChains::reduceRow(int i) noexcept {
  const Row& row = rows_[i];
  double* L_i = factor_.data() + row.at - row.first;
  for (int j = row.first; j <= i; ++j) {
    const Row& other = rows_[j];
    const double* L_j = factor_.data() + other.at - other.first;
    double sum = 0;
    for (const Side& a : row.sides)
      for (const Side& b : other.sides)
        if (a.body >= 0 && a.body == b.body)
          sum += a.angular.dot(b.spin) + a.linear.dot(b.velocity);
    const btSolverConstraint& constraint = (*joints_)[row.index];
    if (j == i) sum += static_cast<double>(constraint.m_cfm / constraint.m_jacDiagABInv);
    const double own = sum;
    for (int k = std::max(row.first, other.first); k < j; ++k) sum -= L_i[k] * L_j[k];
    if (j < i) {
      L_i[j] = sum * L_j[j];
    } else if (sum > kNoPivot * own) {
      L_i[j] = 1 / std::sqrt(sum);
    } else {
      return false;
    }
  }
  return true;
}

// Solves L L^T s = rhs / j - J du for the impulses s.
void JointChains::substitute() noexcept {
  const auto count = static_cast<int>(rows_.size());
  impulse_.resize(rows_.size());
  for (int i = 0; i < count; ++i) {
    const Row& row = rows_[i];
    const double* L = factor_.data() + row.at - row.first;
    double sum = missingVelocity(row);
    for (int j = row.first; j < i; ++j) sum -= L[j] * impulse_[j];
    impulse_[i] = sum * L[i];
  }
  for (int i = count - 1; i >= 0; --i) {
    const Row& row = rows_[i];
    const double* L = factor_.data() + row.at - row.first;
    impulse_[i] *= L[i];
    for (int j = row.first; j < i; ++j) impulse_[j] -= L[j] * impulse_[i];
  }
}

// Returns rhs / j - J du of a row: the velocity change along it that its impulses still have to
// make [m/s].
double JointChains::missingVelocity(const Row& row) const noexcept {
  const btSolverConstraint& constraint = (*joints_)[row.index];
  auto velocity = static_cast<double>(constraint.m_rhs / constraint.m_jacDiagABInv);
  for (const Side& side : row.sides) {
    if (side.body < 0) continue;
    btSolverBody& body = (*bodies_)[side.body];
    velocity -= side.angular.dot(toVector3(body.internalGetDeltaAngularVelocity())) +
                side.linear.dot(toVector3(body.internalGetDeltaLinearVelocity()));
  }
  return velocity;
}

// Sets the impulses of the rows within their bounds, and applies them. Returns the number of rows;
// 0, without effect, if an impulse is not finite.
int JointChains::apply() noexcept {
  for (const double impulse : impulse_)
    if (!std::isfinite(impulse)) return 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    btSolverConstraint& row = (*joints_)[rows_[i].index];
    const btScalar impulse =
        btClamped(static_cast<btScalar>(impulse_[i]), row.m_lowerLimit, row.m_upperLimit);
    row.m_appliedImpulse = impulse;
    btSolverBody &a = (*bodies_)[row.m_solverBodyIdA], &b = (*bodies_)[row.m_solverBodyIdB];
    a.internalApplyImpulse(row.m_contactNormal1 * a.internalGetInvMass(), row.m_angularComponentA,
                           impulse);
    b.internalApplyImpulse(row.m_contactNormal2 * b.internalGetInvMass(), row.m_angularComponentB,
                           impulse);
    RowBody* ambient = ambient_->find(row.m_solverBodyIdA);
    if (!ambient) ambient = ambient_->find(row.m_solverBodyIdB);
    if (ambient) ++ambient->joint_rows;
  }
  return static_cast<int>(rows_.size());
}

AMBIENT_END
