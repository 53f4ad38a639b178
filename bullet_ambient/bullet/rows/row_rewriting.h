#pragma once

#include <BulletDynamics/ConstraintSolver/btSolverBody.h>
#include <BulletDynamics/ConstraintSolver/btSolverConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>
#include <LinearMath/btMatrix3x3.h>

#include <vector>

#include "bullet_ambient/bullet/core/four_numbers.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/rows/row_velocity.h"

struct btMultiBodyJacobianData;

AMBIENT_BEGIN

/// Velocity basis T of docs/theory.md eq. (26) in world axes, in Bullet's precision: u = T u' with
/// u = (w, v). The lower left block is zero.
struct WorldBasis {
  btMatrix3x3 angular = btMatrix3x3::getIdentity();    ///< w from w'
  btMatrix3x3 coupling = {0, 0, 0, 0, 0, 0, 0, 0, 0};  ///< w from v'
  btMatrix3x3 linear = btMatrix3x3::getIdentity();     ///< v from v'
};
WorldBasis toWorld(const Matrix6& basis_B, const Matrix3& rotation_WB);
/// Rotates a diagonal basis into world axes.
WorldBasis toWorld(const Vector6& basis_B, const Matrix3& rotation_WB);

/// T in world axes for a body with locked axes: T D T^T = K_eff^-1 of docs/theory.md eq. (30). T is
/// not constant in body axes, and it is singular: components of u' along locked axes do not move
/// the body. `inertia`: K in B; `mass` of the dry body [kg].
WorldBasis makeLockedBasis(const Matrix6& inertia, double mass, const Matrix3& root_inertia_W,
                           const Matrix3& rotation_WB, const AxisFactors& factors);

/// sqrt(I) in world axes, for principal moments I [kg m^2].
Matrix3 rootInertia(const Vector3& inertia_diagonal, const Matrix3& rotation_WB);

/// Applies an impulse to a body like btSolverBody::internalApplyImpulse, with the same bits.
/// `linear`: linear part of the row's Jacobian; `spin`: spin change by a unit impulse.
AMBIENT_INLINE void applyImpulse(btSolverBody& body, const btVector3& linear, const btVector3& spin,
                                 btScalar impulse) noexcept {
  if (!body.m_originalBody) return;
  const Four change = impulse * (load(linear) * load(body.m_invMass));
  store(body.m_deltaLinearVelocity,
        load(body.m_deltaLinearVelocity) + change * load(body.m_linearFactor));
  store(body.m_deltaAngularVelocity,
        load(body.m_deltaAngularVelocity) + load(spin) * (impulse * load(body.m_angularFactor)));
}

class AmbientTrees;

/// Rows that Bullet has set up for one group of bodies.
struct RowPools {
  btConstraintArray& contacts;
  btConstraintArray& frictions;
  btConstraintArray& torsional_frictions;
  btConstraintArray& joints;
};

/// Rows of multibodies: their contacts, and joints among them or to rigid bodies.
struct MultiBodyRows {
  btAlignedObjectArray<btMultiBodySolverConstraint>& contacts;
  btAlignedObjectArray<btMultiBodySolverConstraint>& frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& rolling_frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& spinning_frictions;
  btAlignedObjectArray<btMultiBodySolverConstraint>& joints;
  btMultiBodyJacobianData& data;  ///< Jacobians of the multibodies and their responses
  const AmbientTrees* trees;      ///< multibodies in fluid; null: none
};

// Rewrites Bullet's rows, so that they feel the total inertia K; docs/theory.md eq. (26) and (27).
//
//   u   velocity of a body in world axes, spin w above, velocity v of the centre of mass below
//   K   total inertia, of body and fluid, in world axes (6x6)
//   D   inverse inertia that Bullet holds, diag(I^-1, 1/m) with the dry body's I and m
//   T   velocity basis, u = T u' with T D T^T = K^-1: in u' the body looks to Bullet as if dry
//   J   Jacobian of a row, one side: J u is its velocity along the row; J_a its angular part
//   j   inverse effective mass of the row, relaxation / (sum of J D J^T over both sides + softness)
//
// A row that Bullet has set up for u becomes one for u':
//
//   J' = J T,  j' = relaxation / (sum of J' D J'^T + softness),  rhs' = (j' / j) rhs - j' J e
//
//   e   velocity change outside the rows in this step, minus the one that Bullet has put into rhs
//
// Joint rows have e = 0. Contact and friction rows were set up with the push k' in place of k, eq.
// (28b); Bullet's friction rows also leave out the spin change. Bullet's iterations, which know J',
// D and j', then solve J K^-1 J^T. After the iterations, du = T du'.

/// Data of one ambient body for its rows in one step. World axes.
struct RowBody {
  WorldBasis basis;
  bool has_coupling = true;        ///< false: basis.coupling is zero
  btMatrix3x3 inverse_inertia_T;   ///< transposed inverse inertia of the dry body [1/(kg m^2)]
  btScalar inverse_mass = 0;       ///< inverse mass of the dry body [1/kg]
  btVector3 spin_change{0, 0, 0};  ///< k + X of eq. (28): velocity change outside the rows [rad/s]
  btVector3 velocity_change{0, 0, 0};  ///< [m/s]
  btVector3 spin_to_hold{0, 0, 0};     ///< k' + 2X where |u_n - X| is less, else 0
  btVector3 spin_excess{0, 0, 0};      ///< k' - k of eq. (28b), added while Bullet sets up contacts
  btVector3 velocity_excess{0, 0, 0};  ///< [m/s]
  btVector3 spin_by_load{0, 0, 0};     ///< part of spin_change by surface loads; 0: no bounces
  btVector3 velocity_by_load{0, 0, 0};  ///< [m/s]
  bool is_anchored = false;  ///< true: has a joint, or a contact with a body that cannot move
  int rows = 0;              ///< number of rewritten rows
  int joint_rows = 0;        ///< number of joint rows solved together before the iterations
  double joint_error = 0;    ///< largest joint_error of a joint in this step, JointErrors [m]
  int joined_to = -1;        ///< solver body at the other side of that joint

  bool is_locked = false;
  btVector3 locked_angular{0, 0, 0};  ///< 1 for an axis that is locked, else 0
  btVector3 locked_linear{0, 0, 0};
  btMatrix3x3 root_inertia;  ///< sqrt(I), set for locked bodies only
};

/// Ambient bodies with rows of one group, found by the id of their solver body. Reuses its memory.
class RowBodies {
 public:
  void reserve(int solver_bodies) {
    bodies_.reserve(static_cast<std::size_t>(solver_bodies));
    index_.reserve(static_cast<std::size_t>(solver_bodies));
  }
  void reset(int solver_body_count);
  RowBody& add(int solver_body);
  bool empty() const { return bodies_.empty(); }
  /// Number of solver bodies of the group, ambient or not.
  std::size_t size() const { return index_.size(); }
  /// Null if the body is not ambient or has no rows. Solver bodies that Bullet appends after
  /// convertBodies() (fixed, kinematic) are not ambient.
  RowBody* find(int solver_body) noexcept {
    if (static_cast<std::size_t>(solver_body) >= index_.size()) return nullptr;
    const int at = index_[solver_body];
    return at < 0 ? nullptr : &bodies_[at];
  }

 private:
  std::vector<RowBody> bodies_;
  std::vector<int> index_;  // by solver body; -1: not ambient
};

/// Solver bodies of a row; none (-1) where a multibody is.
inline int rigidBodyA(const btSolverConstraint& row) { return row.m_solverBodyIdA; }
inline int rigidBodyB(const btSolverConstraint& row) { return row.m_solverBodyIdB; }
inline int rigidBodyA(const btMultiBodySolverConstraint& row) {
  return row.m_multiBodyA ? -1 : row.m_solverBodyIdA;
}
inline int rigidBodyB(const btMultiBodySolverConstraint& row) {
  return row.m_multiBodyB ? -1 : row.m_solverBodyIdB;
}

/// Kinds of rows of the sequential impulse solver. They differ in the velocities that Bullet puts
/// into their right-hand sides.
enum class RowKind { kContact, kFriction, kTorsionalFriction, kJoint };

/// References to the Jacobian and the response of a row at one of its bodies.
struct RowJacobian {
  btVector3& angular;
  btVector3& linear;
  btVector3& angular_component;  ///< spin change by a unit impulse
};

/// Response of a row of a body with locked axes, relative to the response without fluid, below
/// which it is rounding of T: the row acts along locked axes only.
constexpr btScalar kNoResponse = 64 * SIMD_EPSILON;

/// Sets J' = J T at an ambient body, docs/theory.md eq. (27). Returns J' D J'^T [1/kg].
btScalar changeBasis(const RowBody& body, RowJacobian jacobian) noexcept;

/// Returns J D J^T at a body that is not ambient [1/kg].
btScalar inverseEffectiveMass(const btSolverBody& body, const RowJacobian& jacobian) noexcept;

/// Rewrites all rows of a pool that touch ambient bodies, eq. (27). `relaxation`: m_sor of the
/// solver for contact and friction rows, 1 for others.
void rewriteRows(btConstraintArray& rows, RowKind kind, btScalar relaxation, RowBodies& bodies,
                 const btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

/// Applies the warm-starting impulses of rewritten rows to their ambient bodies. `Row`:
/// btSolverConstraint or btMultiBodySolverConstraint.
template <class Row>
void reapplyImpulses(const btAlignedObjectArray<Row>& rows, RowBodies& bodies,
                     btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept {
  for (int i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const btScalar impulse = row.m_appliedImpulse;
    if (impulse == 0) continue;
    const int a = rigidBodyA(row), b = rigidBodyB(row);
    if (bodies.find(a))
      applyImpulse(solver_bodies[a], row.m_contactNormal1, row.m_angularComponentA, impulse);
    if (bodies.find(b))
      applyImpulse(solver_bodies[b], row.m_contactNormal2, row.m_angularComponentB, impulse);
  }
}

// Finds contacts that need two friction rows; docs/theory.md, section 7, "Friction".

/// True if a push on the first body of a contact presses the bodies together, and its part along
/// the face, relative to the part along the normal, is between 0.01 and the coefficient of
/// friction. `normal_W`: from the second body to the first.
bool isInFrictionCone(const btVector3& push_W, const btVector3& normal_W,
                      btScalar friction) noexcept;

/// True if bodies that hardly turn are turned about the normal of a contact, by Munk's moment say,
/// and this moves them along the face by 10^-3 of what presses them together up to the coefficient
/// of friction. @pre the row is as Bullet has made it
bool isTurnedInFrictionCone(const btSolverConstraint& contact, const btVector3& push_W,
                            const btVector3& normal_W, RowBodies& bodies) noexcept;

/// False: deflects() is false for every normal.
bool mayDeflect(const AmbientBody& ambient) noexcept;

/// True if a push along the normal also moves the body across the normal, by more than 10^-3 of its
/// motion, because of added mass.
bool deflects(const AmbientBody& ambient, const btVector3& normal_W) noexcept;

AMBIENT_END
