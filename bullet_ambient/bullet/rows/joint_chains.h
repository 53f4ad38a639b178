#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include <vector>

#include "bullet_ambient/bullet/core/four_numbers.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/chain_factor.h"
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
// only entries from the first nonzero one of a row to its diagonal are stored (chain_factor.h).
// Rows with bounds (limits, motors, springs) and rows of bodies with locked axes are left to the
// iterations. So are joints in loops, whose rows may contradict each other.

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
  SolverBodies* solver_bodies_ = nullptr;

  std::vector<Body> bodies_;
  std::vector<int> next_end_;  // by end: the one before it at the same body
  std::vector<int> queue_;     // bodies of the present chain
  std::vector<int> rows_;      // rows of the present chain, in the pool
  std::vector<Side> sides_;    // two per row of the present chain; beyond them unused ones
  ChainFactor factor_;
  std::vector<double> impulses_;  // of the present chain, zeros up to a multiple of four
};

AMBIENT_END
