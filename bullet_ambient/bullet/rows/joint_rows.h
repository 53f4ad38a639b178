#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <cstddef>
#include <vector>

#include "bullet_ambient/bullet/core/four_numbers.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"

AMBIENT_BEGIN

/// Returns the joint of a row in the pool of joint rows.
inline const btTypedConstraint* constraintOf(const btSolverConstraint& row) {
  return static_cast<const btTypedConstraint*>(row.m_originalContactPoint);
}

/// True if the impulse of a joint row has other bounds than the joint's breaking impulse: the row
/// is a limit, a motor or a spring.
inline bool hasBounds(const btSolverConstraint& row) {
  const btScalar most = constraintOf(row)->getBreakingImpulseThreshold();
  return row.m_lowerLimit > -most || row.m_upperLimit < most;
}

/// Gap of a joint per step, relative to the size of its body, that is reported after kStepsToReport
/// steps in a row.
constexpr double kLargeJointError = 0.05;
constexpr int kStepsToReport = 10;

/// Finds joints that the solver does not hold. The joint_error of a joint row against translation
/// is the step times the larger of two velocities [m]: the difference between the velocity that the
/// row asks for and the one that the iterations have reached (0 if the impulse is at a bound), and
/// the velocity of position correction. Reuses its memory.
class JointErrors {
 public:
  /// Stores the rows of ambient bodies against translation, and their position corrections. Call
  /// before rows are rewritten: later, Jacobians and right-hand sides no longer tell these.
  void watch(const RowPools& pools, RowBodies& ambient) noexcept;
  /// Writes the largest joint_error of each ambient body to RowBody::joint_error. Call after the
  /// iterations; `time_step` [s].
  void measure(const RowPools& pools, RowBodies& ambient, double time_step) const noexcept;

 private:
  struct Row {
    int index;          ///< index in the pool of joint rows
    double correction;  ///< velocity of position correction [m/s]
  };
  std::vector<Row> rows_;
};

// Factors a symmetric, positive definite matrix S by Cholesky's method, S = L L^T. Stores the
// entries from the first nonzero one of a row to its diagonal, and for L the inverse of the
// diagonal. Four rows stand side by side, column after column. Each sum is taken in the order of
// columns, so that its bits do not depend on how many numbers the processor takes at a time.

/// Holds a matrix of the rows of a chain of joints, and then its factor in the same place. Reuses
/// its memory.
class ChainFactor {
 public:
  /// Removes all rows.
  void clear();
  /// Appends a row; `first`: column of its first entry, at most that of its diagonal.
  void addRow(int first);
  /// Sets all entries to zero. Returns false if the factor would cost too much: chains with dozens
  /// of joints on one body.
  bool begin();
  /// Gives the entries of a row by their columns.
  class Row {
   public:
    Row(double* begin, int first) : begin_(begin), first_(first) {}
    double& operator[](int column) const { return begin_[4 * (column - first_)]; }

   private:
    double* begin_;
    int first_;
  };
  /// Returns a row up to its diagonal, to be filled between begin() and factorize().
  Row row(int i) {
    const Group& group = groups_[static_cast<std::size_t>(i / 4)];
    return {elements_.data() + group.at + i % 4, group.first};
  }
  /// Replaces the matrix by its factor. Returns false if its rows depend on each other.
  bool factorize() noexcept;
  /// Replaces x by S^-1 x. `x` has room for a multiple of four numbers, zeros beyond the rows.
  void solve(double* x) const noexcept;

  /// Four rows, or what is left of them.
  struct Group {
    int first;       ///< least column
    std::size_t at;  ///< where its elements begin
  };

 private:
  int size_ = 0;
  double work_ = 0;
  std::vector<Group> groups_;
  std::vector<double> elements_;
};

// Solves the rows of joints without loops together, before Bullet's iterations, which start from
// the impulses s:
//
//   (J K^-1 J^T + c / j) s = rhs / j - J du                       docs/theory.md eq. (27a)
//
//   J    Jacobian of the rows;  K  total inertia of the bodies
//   rhs, c, j   right-hand side, softness (cfm) and inverse effective mass of each row
//   du   velocity change by warm starting
//
// Reason: added mass makes a light body hard to push, but hardly harder to turn. Two rows of its
// joint are then nearly opposite, and ten iterations leave much of them unsolved. The joint_error
// that remains comes back as energy by position correction.
//
// The matrix is factored by Cholesky's method. Rows are ordered along the chain of joints, so that
// only entries from the first nonzero one of a row to its diagonal are stored.
// Rows with bounds (limits, motors, springs) and rows of bodies with locked axes are left to the
// iterations. So are joints in loops, whose rows may contradict each other.

/// Solves the joint rows of ambient bodies, and of bodies joined to them. Reuses its memory.
class JointChains {
 public:
  /// Reserves memory for a group of so many bodies.
  void reserve(int solver_bodies);
  /// Solves rows that were rewritten, sets their impulses and applies them to the bodies. Returns
  /// the number of rows solved, and adds it to RowBody::joint_rows.
  int solve(const RowPools& pools, RowBodies& ambient) noexcept;

 private:
  enum class Kind : char {
    kFixed,  // cannot move
    kPlain,  // its response is symmetric and the same in all its rows
    kOther   // has locked axes, or belongs to another group
  };
  // A solver body. An end is a row of the pool at one of its bodies: twice its index, plus 1 for
  // body B.
  struct Body {
    Kind kind = Kind::kFixed;
    bool is_ambient = false;
    bool is_visited = false;
    int end = -1;                                   // last end at it; -1: none
    int side = -1;                                  // last of sides_ at it; -1: none
    int first_row = -1;                             // its first row in rows_; -1: none
    const btTypedConstraint* entered_by = nullptr;  // joint by which it was found
    DoublePairs change;  // of spin and velocity by warm starting, set unless it cannot move
  };
  // Jacobian and response of a row at one of its bodies, angular and linear. World axes.
  struct Side {
    int body;    // solver body; -1: one that cannot move
    int before;  // side of an earlier row at the same body; -1: none
    DoublePairs jacobian;
    DoublePairs response;  // velocity change by a unit impulse
  };

  Body describe(int body) const noexcept;
  bool linkBodies() noexcept;
  int solveChain(int root) noexcept;
  bool gatherChain(int root) noexcept;
  void addRow(int index) noexcept;
  int addSide(Side& side, int body, const btVector3& angular, const btVector3& linear,
              const btVector3& angular_component) noexcept;
  void fillMatrix() noexcept;
  double missingVelocity(int row) const noexcept;
  int apply() noexcept;

  btConstraintArray* joints_ = nullptr;
  RowBodies* ambient_ = nullptr;
  btAlignedObjectArray<btSolverBody>* solver_bodies_ = nullptr;

  std::vector<Body> bodies_;
  std::vector<int> next_end_;  // by end: the one before it at the same body
  std::vector<int> queue_;     // bodies of the present chain
  std::vector<int> rows_;      // rows of the present chain, in the pool
  std::vector<Side> sides_;    // two per row of the present chain; beyond them unused ones
  ChainFactor factor_;
  std::vector<double> impulses_;  // of the present chain, zeros up to a multiple of four
};

AMBIENT_END
