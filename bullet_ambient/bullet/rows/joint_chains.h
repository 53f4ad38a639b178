#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include <cstddef>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"

class btTypedConstraint;

AMBIENT_BEGIN

// Impulses with which rows of joints begin the iterations. Water raises what a light body resists
// to a push and hardly what it resists to a turn; the rows of its joints then oppose each other so
// nearly that Bullet's iterations leave much of them unsolved, and what position correction asks
// for comes back as energy. So the rows of joints without loops are solved together before,
//
//   (J K^-1 J^T + c / j) s = rhs / j - J du                       docs/theory.md eq. (27a)
//
//   s   impulses that the iterations begin with;  c  softness of the row, cfm of joints
//   du  what warm starting has changed
//
// by a Cholesky factor of the rows in the order in which they hang together, within its envelope.
// A row with bounds (limits, motors, springs) or of a body with locked axes is left to the
// iterations, and so are joints in loops, whose rows may contradict each other.

/// Solves the joint rows of ambient bodies, and of bodies joined to them. Keeps its memory.
class JointChains {
 public:
  using SolverBodies = btAlignedObjectArray<btSolverBody>;

  void reserve(int solver_bodies);
  /// After the rows were rewritten. Returns how many it has solved, and counts them for the ambient
  /// bodies.
  int solve(btConstraintArray& joints, RowBodies& ambient, SolverBodies& bodies) noexcept;

 private:
  // One row seen from one of its bodies, which can move.
  struct Side {
    int body;  // -1: none
    Vector3 angular, linear;
    Vector3 spin, velocity;  // that a unit impulse gives
  };
  struct Row {
    int index;       // in the pool
    int first;       // earliest row of the chain that shares a body with it
    std::size_t at;  // where its part of the factor begins: columns first to itself
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

  std::vector<int> first_link_;                       // by body: where its rows begin in links_
  std::vector<int> links_;                            // rows of the pool, by body
  std::vector<const btTypedConstraint*> entered_by_;  // by body: the joint that led to it
  std::vector<char> is_visited_;
  std::vector<int> first_row_;  // by body, of the chain
  std::vector<int> queue_;      // bodies of the chain
  std::vector<Row> rows_;       // of the chain
  std::vector<double> factor_, impulse_;
};

AMBIENT_END
