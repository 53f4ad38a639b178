#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/core/velocity_basis.h"
#include "bullet_ambient/motion/body/rigid_state.h"

AMBIENT_BEGIN

// Rewriting of Bullet's rows, so that they feel the full inertia; docs/theory.md eq. (26) and (27).
//
//   u   velocity of a body in world axes, spin w above, velocity v of the centre of mass below
//   K   total inertia, of body and fluid, in world axes (6x6)
//   D   inverse inertia that Bullet holds, diag(I^-1, 1/m) with the dry body's I and m
//   T   velocity basis, u = T u' with T D T^T = K^-1: in u' the body looks to Bullet as if dry
//   J   Jacobian of a row, one side: J u is its velocity along the row; J_a its angular part
//   j   inverse effective mass of the row, relaxation / (sum of J D J^T over both sides + softness)
//   s   j' / j, new over old
//
// A row that Bullet has set up for u becomes one for u':
//
//   J' = J T,  j' = relaxation / (sum of J' D J'^T + softness),  rhs' = s rhs
//
// and the stock iterations, which know J', D and j', solve J K^-1 J^T. What a row has not seen of
// the change of velocity outside the rows in this step, or too much, is taken from rhs' by j' J:
// friction rows leave out the change of spin, and those of contacts were set up with a push that
// does not turn aside. After the iterations du = T du'.

/// One ambient body as its rows see it during one step. World axes.
struct RowBody {
  WorldBasis basis;
  bool has_coupling = true;        ///< of the spin to velocities, in the basis
  btMatrix3x3 inverse_inertia_T;   ///< Bullet's, without fluid, transposed as to rounding
  btScalar inverse_mass = 0;       ///< Bullet's, without fluid
  btVector3 spin_change{0, 0, 0};  ///< of the step, outside the rows
  btVector3 velocity_change{0, 0, 0};
  btVector3 spin_aside{0, 0, 0};  ///< more than that is shown to contacts as they are set up
  btVector3 velocity_aside{0, 0, 0};
  RigidState start;      ///< in which the solver meets it
  Twist turning_W;       ///< share of the turning part in the velocity that rows are solved against
  double extent = 0;     ///< of the turn in this step
  bool is_held = false;  ///< by joints, or by what cannot move
  int rows = 0;          ///< how many were rewritten
  int joint_rows = 0;    ///< how many of them were solved together before the iterations
  double gap = 0;        ///< by which a joint misses in this step [m]
  int gap_to = -1;       ///< the solver body at its other side

  bool is_locked = false;
  btVector3 locked_angular{0, 0, 0};  ///< 1 for an axis that is locked, else 0
  btVector3 locked_linear{0, 0, 0};
  btMatrix3x3 root_inertia;  ///< sqrt(I), set for locked bodies only
};

/// The ambient bodies with rows of a solver's group, by the id of their solver body. Keeps its
/// memory.
class RowBodies {
 public:
  void reserve(int solver_bodies) {
    bodies_.reserve(static_cast<std::size_t>(solver_bodies));
    index_.reserve(static_cast<std::size_t>(solver_bodies));
  }
  void reset(int solver_body_count);
  RowBody& add(int solver_body);
  bool empty() const { return bodies_.empty(); }
  /// Solver bodies of the group, ambient or not.
  std::size_t size() const { return index_.size(); }
  /// Null if not ambient. Bodies that Bullet appends after convertBodies() (fixed, kinematic) never
  /// are.
  RowBody* find(int solver_body) noexcept {
    if (static_cast<std::size_t>(solver_body) >= index_.size()) return nullptr;
    const int at = index_[solver_body];
    return at < 0 ? nullptr : &bodies_[at];
  }

 private:
  std::vector<RowBody> bodies_;
  std::vector<int> index_;  // by solver body; -1: not ambient
};

/// Kinds of rows of the sequential impulse solver; they differ in what Bullet puts into their
/// right-hand side.
enum class RowKind { kContact, kFriction, kTorsionalFriction, kJoint };

/// The Jacobian of one body of a row, in place.
struct RowSide {
  btVector3& angular;
  btVector3& linear;
  btVector3& angular_component;  ///< response of the spin to a unit impulse
};

/// Part of the response without fluid below which a row of a locked body has none: rounding of T.
constexpr btScalar kNoResponse = 64 * SIMD_EPSILON;

/// J' = J T for an ambient body, docs/theory.md eq. (27). Returns J' D J'^T [1/kg].
btScalar changeBasis(const RowBody& body, RowSide side) noexcept;

/// J D J^T of a body that is not ambient [1/kg].
btScalar inverseEffectiveMass(const btSolverBody& body, const RowSide& side) noexcept;

/// Brings all rows of a pool that touch ambient bodies into their velocity bases. `relaxation`: the
/// solver's m_sor for contact and friction rows, 1 for the others.
void rewriteRows(btConstraintArray& rows, RowKind kind, btScalar relaxation, RowBodies& bodies,
                 const btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

/// Applies the impulses that contact rows begin with to ambient bodies, in their bases.
void reapplyImpulses(const btConstraintArray& rows, RowBodies& bodies,
                     btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

AMBIENT_END
