#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include <cstddef>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

class btTypedConstraint;

AMBIENT_BEGIN

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
// joint are then nearly opposite, and ten iterations leave much of them unsolved. The gap that
// remains comes back as energy by position correction.
//
// The matrix is factored by Cholesky's method. Rows are ordered along the chain of joints, so that
// only entries from the first nonzero one of a row to its diagonal are stored. Rows with bounds
// (limits, motors, springs) and rows of bodies with locked axes are left to the iterations. So are
// joints in loops, whose rows may contradict each other.

/// Solves the joint rows of ambient bodies, and of bodies joined to them. Reuses its memory.
class JointChains {
 public:
  using SolverBodies = btAlignedObjectArray<btSolverBody>;

  /// Reserves memory for a group of so many bodies.
  void reserve(int solver_bodies);
  /// Solves rows that were rewritten, sets their impulses and applies them to the bodies. Returns
  /// the number of rows solved, and adds it to RowBody::joint_rows.
  int solve(btConstraintArray& joints, RowBodies& ambient, SolverBodies& bodies) noexcept;

 private:
  // Jacobian and response of a row at one of its bodies. World axes.
  struct Side {
    int body;                 // solver body; -1: none, or one that cannot move
    Vector3 angular, linear;  // Jacobian
    Vector3 spin, velocity;   // velocity change by a unit impulse
  };
  struct Row {
    int index;       // in the pool
    int first;       // column of its first entry in the factor: first row that shares a body
    std::size_t at;  // position of that entry in factor_
    Side sides[2];
  };

  void linkBodies() noexcept;
  int solveChain(int root) noexcept;
  bool gatherChain(int root) noexcept;
  void addRow(int index) noexcept;
  bool factorize() noexcept;
  bool reduceRow(int i) noexcept;
  void substitute() noexcept;
  double missingVelocity(const Row& row) const noexcept;
  int apply() noexcept;
  bool isPlain(int body) const noexcept;
  bool canMove(int body) const noexcept;
  Side sideOf(int body, const btVector3& angular, const btVector3& linear,
              const btVector3& angular_component) const noexcept;
  int otherBody(int row, int body) const noexcept;

  btConstraintArray* joints_ = nullptr;
  RowBodies* ambient_ = nullptr;
  SolverBodies* bodies_ = nullptr;

  std::vector<int> first_link_;  // by body: position of its first row in links_
  std::vector<int> links_;       // rows (index in the pool) of all bodies, one body after another
  std::vector<const btTypedConstraint*> entered_by_;  // by body: joint by which it was found
  std::vector<char> is_visited_;                      // by body
  std::vector<int> first_row_;                        // by body: its first row in rows_; -1: none
  std::vector<int> queue_;                            // bodies of the present chain
  std::vector<Row> rows_;                             // rows of the present chain
  std::vector<double> factor_, impulse_;
};

AMBIENT_END
