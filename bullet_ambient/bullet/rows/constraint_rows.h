#pragma once

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySolverConstraint.h>
#include <LinearMath/btMatrix3x3.h>

#include <array>
#include <optional>
#include <type_traits>
#include <vector>

#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/four_numbers.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/warnings.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/motion/rows/row_velocity.h"

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

/// Pools of a solver for rows of multibodies: their contacts, and joints among them or to rigid
/// bodies.
struct MultiBodyRows {
  btMultiBodyConstraintArray& contacts;
  btMultiBodyConstraintArray& frictions;
  btMultiBodyConstraintArray& rolling_frictions;
  btMultiBodyConstraintArray& spinning_frictions;
  btMultiBodyConstraintArray& joints;
  btMultiBodyJacobianData& data;  ///< Jacobians of the multibodies and their responses
};

/// Pools in which a solver of Bullet keeps the rows of one group and its bodies.
struct RowPools {
  btAlignedObjectArray<btSolverBody>& solver_bodies;
  btConstraintArray& contacts;
  btConstraintArray& frictions;
  btConstraintArray& torsional_frictions;
  btConstraintArray& joints;
  std::optional<MultiBodyRows> multibodies;  ///< none: the solver knows no multibodies
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

/// References to the Jacobian and the response of a row at a rigid body.
struct RowJacobian {
  btVector3& angular;
  btVector3& linear;
  btVector3& angular_component;  ///< spin change by a unit impulse

  /// Returns the velocity along the row.
  btScalar along(const btVector3& velocity, const btVector3& spin) const {
    return linear.dot(velocity) + angular.dot(spin);
  }
};

/// One side of a row: a rigid body, a multibody, or nothing.
struct RowSide {
  RowJacobian rigid;  ///< set if there is a rigid body
  int solver_body;    ///< -1: none
  btMultiBody* multibody = nullptr;
  int jacobian = 0;  ///< where that of the multibody begins in btMultiBodyJacobianData
  int change = 0;    ///< where its velocity change begins there

  /// Returns the velocity along the row of a multibody whose coordinates are at(i).
  template <class Coordinate>
  btScalar along(const btMultiBodyJacobianData& data, const Coordinate& at) const {
    btScalar sum = 0;
    for (int i = 0; i < multibody->getNumDofs() + 6; ++i)
      sum += data.m_jacobians[jacobian + i] * at(i);
    return sum;
  }
};

/// True for rows of multibodies.
template <class Row>
constexpr bool kIsOfMultiBodies = std::is_same_v<Row, btMultiBodySolverConstraint>;

/// Returns both sides of a row. `Row`: btSolverConstraint or btMultiBodySolverConstraint.
template <class Row>
std::array<RowSide, 2> sidesOf(Row& row) {
  const RowJacobian a{row.m_relpos1CrossNormal, row.m_contactNormal1, row.m_angularComponentA};
  const RowJacobian b{row.m_relpos2CrossNormal, row.m_contactNormal2, row.m_angularComponentB};
  if constexpr (kIsOfMultiBodies<Row>) {
    return {{{a, row.m_multiBodyA ? -1 : row.m_solverBodyIdA, row.m_multiBodyA, row.m_jacAindex,
              row.m_deltaVelAindex},
             {b, row.m_multiBodyB ? -1 : row.m_solverBodyIdB, row.m_multiBodyB, row.m_jacBindex,
              row.m_deltaVelBindex}}};
  } else {
    return {{{a, row.m_solverBodyIdA}, {b, row.m_solverBodyIdB}}};
  }
}

/// Kinds of rows of the sequential impulse solver. They differ in the velocities that Bullet puts
/// into their right-hand sides.
enum class RowKind { kContact, kFriction, kTorsionalFriction, kJoint };

/// Response of a row of a body with locked axes, relative to the response without fluid, below
/// which it is rounding of T: the row acts along locked axes only.
constexpr btScalar kNoResponse = 64 * SIMD_EPSILON;

/// Sets J' = J T at an ambient body, docs/theory.md eq. (27). Returns J' D J'^T [1/kg].
btScalar changeBasis(const RowBody& body, const RowJacobian& jacobian) noexcept;

/// Returns J D J^T at a body that is not ambient [1/kg].
btScalar inverseEffectiveMass(const btSolverBody& body, const RowJacobian& jacobian) noexcept;

/// Rewrites all rows of a pool that touch ambient bodies, eq. (27). `relaxation`: m_sor of the
/// solver for contact and friction rows, 1 for others.
void rewriteRows(btConstraintArray& rows, RowKind kind, btScalar relaxation, RowBodies& bodies,
                 const btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

/// Applies the warm-starting impulses of rewritten rows to their ambient bodies. `Row`:
/// btSolverConstraint or btMultiBodySolverConstraint.
template <class Row>
void reapplyImpulses(btAlignedObjectArray<Row>& rows, RowBodies& bodies,
                     btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept {
  for (int i = 0; i < rows.size(); ++i) {
    const btScalar impulse = rows[i].m_appliedImpulse;
    if (impulse == 0) continue;
    for (const RowSide& side : sidesOf(rows[i]))
      if (bodies.find(side.solver_body))
        applyImpulse(solver_bodies[side.solver_body], side.rigid.linear,
                     side.rigid.angular_component, impulse);
  }
}

/// Rewrites rows of multibodies that touch an ambient body or a tree in fluid, and rescales their
/// effective masses, right-hand sides and softness. The side of an ambient body is brought into its
/// velocity basis, J' = J T, docs/theory.md eq. (27). Bullet computes its velocity in these rows
/// with the dry body's forces, or without forces: the difference to k + X of eq. (28) is added. The
/// side of a tree keeps J and gets the response H^-1 J^T, docs/theory.md section 14; TreeGroup has
/// set its velocity before Bullet made the rows.
void rewriteMultiBodyRows(const RowPools& rows, const btContactSolverInfo& info,
                          const AmbientTrees& trees, RowBodies& bodies) noexcept;

/// Solves the two friction rows of a contact of a multibody together, their impulse within the
/// circle of their limits, like btMultiBodyConstraintSolver::resolveConeFrictionConstraintRows(),
/// but without the C library's arc tangent, sine and cosine. Returns the sum of the velocities
/// along the rows that the impulses change [m/s].
btScalar solveFrictionPair(btMultiBodySolverConstraint& first, btMultiBodySolverConstraint& second,
                           btMultiBodyJacobianData& data,
                           btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept;

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

// Bullet's functions that solve one row, with four numbers per instruction. Bullet's build on Linux
// computes one number after another. Sums are added in Bullet's order, so that impulses, velocities
// and residuals have the same bits.
//
//   ds = rhs - c s - j (J_1 du_1 + J_2 du_2),   s' = clamp(s + ds),   du_i += D_i J_i^T (s' - s)
//
//   s  impulse of the row;  rhs, c, j  its right-hand side, softness, inverse effective mass
//   J_i, D_i, du_i  Jacobian, inverse inertia and velocity change of the two bodies

/// Rows of a pool in the order in which an iteration takes them.
struct RowPass {
  btConstraintArray& rows;
  const btAlignedObjectArray<int>& order;
  btAlignedObjectArray<btSolverBody>& bodies;
};

/// Functions that solve rows. A residual is the velocity along a row that its impulse changes
/// [m/s].
struct QuickRows {
  /// Solves a row between a lower and an upper limit. Returns its residual.
  btSingleConstraintRowSolver generic;
  /// Solves a row with a lower limit alone, a contact. Returns its residual.
  btSingleConstraintRowSolver lower_limit;
  /// Solves all contact rows. Returns the largest squared residual, or `largest` if that is larger.
  btScalar (*contacts)(const RowPass& pass, btScalar largest);
  /// Solves the friction rows of contacts whose impulse is positive, between -mu and mu times that
  /// impulse. Returns a value like contacts().
  btScalar (*frictions)(const RowPass& pass, const btConstraintArray& contacts, btScalar largest);
  /// Joints in turn, those that take part in an iteration. Returns as contacts().
  btScalar (*joints)(const RowPass& pass, int iteration, btScalar largest);
};

/// Returns the row functions for the processor's instruction set.
const QuickRows& quickRows() noexcept;

/// Contacts of a group whose bodies bounce in this step. Bullet asks for the speed of the bounce at
/// the end of the step; bodies in a fluid then have also moved all of the step by it, and would
/// gain the work of their weight on this way. So the speed is lessened by what the forces change in
/// the step, docs/theory.md eq. (28e). That takes an iteration without the bounces: find(),
/// suspend(), iterations, resume(). Without restitution each call costs a test per contact. Reuses
/// its memory.
class Bounces {
 public:
  /// Adds the bounces that touch an ambient body or a tree. Call before the rows are rewritten.
  void find(const RowPools& rows, const btContactSolverInfo& info, const AmbientTrees& trees,
            RowBodies& bodies) noexcept;
  bool empty() const { return bounces_.empty(); }
  void clear() { bounces_.clear(); }
  /// Keeps these contacts from pushing. @pre the rows are rewritten
  void suspend(const RowPools& rows) noexcept;
  /// Lets them push, and sets the velocities that they ask for by what the rows have changed since.
  void resume(const RowPools& rows, const AmbientTrees& trees, RowBodies& bodies) noexcept;

 private:
  struct Bounce {
    bool is_of_multibodies;  // in their pool
    int row;                 // index in its pool
    btScalar speed;          // restitution times that of the approach [m/s]
    btScalar asked;          // velocity that Bullet asks for [m/s]
    btScalar correction;     // part of it by penetration; < 0: by a gap [m/s]
    btScalar push, load;     // change by all forces outside the rows; by surface loads [m/s]
    btScalar right_side;     // of the row, while it is suspended
  };
  template <class Visit>
  void visit(const RowPools& rows, const Visit& visit) noexcept;

  std::vector<Bounce> bounces_;
};

// Bullet moves a body with rows by the velocity xi after the rows. Then the body gets the velocity
// of the same momentum P at the new pose, docs/theory.md eq. (31), in a fast turn with twice its
// energy at most E, eq. (31a). Velocities are relative to the flow:
//
//   xi = x + X + d,   P = K(q_n) (x + d),   E = |x + d|^2 + min(0, 2 X.K d)
//
//   x   velocity changed by forces and loads
//   X   part of the turning velocity change in the velocity that rows are solved against, eq. (28)
//   d   velocity change by the rows

/// Returns the velocity change by rows after the iterations, world axes.
inline Twist changeByRows(btSolverBody& b) {
  return {toVector3(b.internalGetDeltaAngularVelocity()),
          toVector3(b.internalGetDeltaLinearVelocity())};
}

/// Returns the velocity that Bullet will write back, world axes.
inline Twist solvedVelocity(btSolverBody& b) {
  return {toVector3(b.m_angularVelocity + b.internalGetDeltaAngularVelocity() +
                    b.m_externalTorqueImpulse),
          toVector3(b.m_linearVelocity + b.internalGetDeltaLinearVelocity() +
                    b.m_externalForceImpulse)};
}

/// Up to kFlightsTogether ambient bodies of a group that rows may move, from the preparation of
/// their rows to the end of the iterations. The bits of a body do not depend on the others.
struct RowBatch {
  RowLanes lanes;
  int count = 0;
  AmbientBody* bodies[kFlightsTogether] = {};
  int solver_bodies[kFlightsTogether] = {};                  ///< indices in the solver's pool
  Vector3 positions[kFlightsTogether];                       ///< centres of mass at the start [m]
  std::optional<Matrix6> settled_inertia[kFlightsTogether];  ///< of RowVelocity
  Wrench loads_W[kFlightsTogether];                          ///< RowLoad::mean_W
};

/// Stores momentum, energy bound and start of the active bodies in AmbientBody::outcome for
/// endRowMotions(). Makes the turns by split impulses; `turn_share`: the part of them that Bullet
/// makes. `solver_bodies`: with velocity changes in world axes.
void beginRowMotions(RowBatch& batch, RowBodies& row_bodies,
                     btAlignedObjectArray<btSolverBody>& solver_bodies, double turn_share,
                     double time_step) noexcept;

/// Adds the velocity changes x_(n+1) - xi of eq. (31), in world axes. Call after Bullet has moved
/// the bodies; turns them to the attitudes of their ways. Does nothing for a body that is not on
/// its way from the start along xi, because others have moved it. At most kFlightsTogether bodies.
void endRowMotions(AmbientBody* const* bodies, int count, double time_step,
                   Warnings& warnings) noexcept;

AMBIENT_END
