#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/conversions.h"
#include "bullet_ambient/bullet/core/four_numbers.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"

AMBIENT_BEGIN

WorldBasis toWorld(const Matrix6& basis_B, const Matrix3& R) {
  AMBIENT_ASSERT(isRotation(R));
  AMBIENT_ASSERT(basis_B.allFinite());
  const Matrix3 angular = R * basis_B.topLeftCorner<3, 3>() * R.transpose();
  const Matrix3 coupling = R * basis_B.topRightCorner<3, 3>() * R.transpose();
  const Matrix3 linear = R * basis_B.bottomRightCorner<3, 3>() * R.transpose();
  return {toBulletMatrix(angular), toBulletMatrix(coupling), toBulletMatrix(linear)};
}

WorldBasis toWorld(const Vector6& basis_B, const Matrix3& R) {
  AMBIENT_ASSERT(isRotation(R) && basis_B.minCoeff() > 0);
  const Matrix3 angular = R * basis_B.head<3>().asDiagonal() * R.transpose();
  const Matrix3 linear = R * basis_B.tail<3>().asDiagonal() * R.transpose();
  WorldBasis T;
  T.angular = toBulletMatrix(angular);
  T.linear = toBulletMatrix(linear);
  return T;
}

Matrix3 rootInertia(const Vector3& inertia_diagonal, const Matrix3& R) {
  AMBIENT_ASSERT(inertia_diagonal.minCoeff() > 0 && isRotation(R));
  return R * inertia_diagonal.cwiseSqrt().asDiagonal() * R.transpose();
}

WorldBasis makeLockedBasis(const Matrix6& inertia, double mass, const Matrix3& root_inertia_W,
                           const Matrix3& R, const AxisFactors& factors) {
  const Matrix6 K_W = rotateAxes(inertia, R);
  Matrix6 root = Cholesky<6>(freeInertia(K_W, factors)).inverseTransposed();
  // Rows scaled by the factors; columns of locked axes must not move the body.
  const Vector6 scale = stack(factors.angular, factors.linear);
  for (int axis = 0; axis < 6; ++axis) {
    if (scale[axis] == 0) root.col(axis).setZero();
    root.row(axis) *= scale[axis];
  }
  root.leftCols<3>() = (root.leftCols<3>() * root_inertia_W).eval();
  root.rightCols<3>() *= std::sqrt(mass);
  return {toBulletMatrix(root.topLeftCorner<3, 3>()), toBulletMatrix(root.topRightCorner<3, 3>()),
          toBulletMatrix(root.bottomRightCorner<3, 3>())};
}

namespace {

// A rigid body at one side of a row. `ambient`: null if the body is not ambient.
struct RigidSide {
  RowBody* ambient;
  const btSolverBody& solver_body;
  RowJacobian jacobian;
};

// Returns v M = M^T v.
AMBIENT_INLINE Four product(const btVector3& v, const btMatrix3x3& M) {
  return v.m_floats[0] * load(M[0]) + v.m_floats[1] * load(M[1]) + v.m_floats[2] * load(M[2]);
}

// Products of components, whose sums over the three components are parts of a scalar product.
struct PartProducts {
  Four angular, linear;
};

// Returns products of J and e at one side, with e of constraint_rows.h. The linear part has the
// opposite sign: e_l = -velocity_excess.
AMBIENT_INLINE PartProducts unseenProducts(RowKind kind, const RigidSide& side) {
  if (!side.ambient) return {anyZero(), anyZero()};
  const RowBody& body = *side.ambient;
  const btVector3 spin = kind == RowKind::kContact ? -body.spin_excess : body.spin_change;
  return {load(side.jacobian.angular) * load(spin),
          load(side.jacobian.linear) * load(body.velocity_excess)};
}

// Returns J e of both sides: the velocity change along the row outside the rows, minus the one that
// Bullet has put into the right-hand side.
AMBIENT_INLINE btScalar unseenChange(RowKind kind, const RigidSide& a, const RigidSide& b) {
  if (kind == RowKind::kJoint) return 0;
  const PartProducts of_a = unseenProducts(kind, a), of_b = unseenProducts(kind, b);
  const Four sums = sumsOfThree(of_a.angular, of_a.linear, of_b.angular, of_b.linear);
  return (sums[0] - sums[1]) + (sums[2] - sums[3]);
}

// Sets J' = J T. Returns the products of J' D J'^T; the linear ones without the inverse mass.
AMBIENT_INLINE PartProducts changedProducts(const RowBody& body, const RowJacobian& jacobian) {
  const WorldBasis& T = body.basis;
  Four linear = product(jacobian.linear, T.linear);
  if (body.has_coupling) linear = linear + product(jacobian.angular, T.coupling);
  const Four angular = product(jacobian.angular, T.angular);
  store(jacobian.linear, linear);
  store(jacobian.angular, angular);
  const Four component = product(jacobian.angular, body.inverse_inertia_T);
  store(jacobian.angular_component, component);
  return {angular * component, linear * linear};
}

// Returns the products of J' D J'^T at one side; brings an ambient body's side into its basis.
AMBIENT_INLINE PartProducts responseProducts(const RigidSide& side) {
  const RowJacobian& jacobian = side.jacobian;
  if (side.ambient) return changedProducts(*side.ambient, jacobian);
  const Four linear = load(jacobian.linear);
  return {load(jacobian.angular) * load(jacobian.angular_component),
          linear * (linear * load(side.solver_body.m_invMass))};
}

// Returns the sum of J' D J'^T over both sides; brings the sides of ambient bodies into their
// bases.
AMBIENT_INLINE btScalar inverseEffectiveMass(const RigidSide& a, const RigidSide& b) {
  const PartProducts of_a = responseProducts(a), of_b = responseProducts(b);
  const Four sums = sumsOfThree(of_a.linear, of_a.angular, of_b.linear, of_b.angular);
  const auto massOf = [](const RigidSide& side) {
    return side.ambient ? side.ambient->inverse_mass : btScalar(1);
  };
  return (sums[0] * massOf(a) + sums[1]) + (sums[2] * massOf(b) + sums[3]);
}

// Returns J D J^T at an ambient body.
btScalar diagonal(const RowBody& body, const RowJacobian& jacobian) {
  return jacobian.linear.length2() * body.inverse_mass +
         jacobian.angular.dot(jacobian.angular_component);
}

// Returns J K^-1 J^T at one side; does not change the row.
btScalar responseOf(const RigidSide& side) {
  btVector3 angular = side.jacobian.angular, linear = side.jacobian.linear;
  btVector3 angular_component = side.jacobian.angular_component;
  const RowJacobian copy{angular, linear, angular_component};
  return side.ambient ? changeBasis(*side.ambient, copy)
                      : inverseEffectiveMass(side.solver_body, copy);
}

// Replaces J at an ambient body by J P sqrt(D)^-1, where P projects on the locked axes. This row
// moves nothing, because T is zero along locked axes, and is orthogonal to all rows that move the
// body. Returns its J D J^T.
btScalar pointAlongLockedAxes(const RigidSide& side) {
  if (!side.ambient) return 0;
  const RowBody& body = *side.ambient;
  const RowJacobian& jacobian = side.jacobian;
  jacobian.angular = body.root_inertia * (jacobian.angular * body.locked_angular);
  jacobian.linear = jacobian.linear * body.locked_linear / btSqrt(body.inverse_mass);
  store(jacobian.angular_component, product(jacobian.angular, body.inverse_inertia_T));
  return diagonal(body, jacobian);
}

// Scales Jacobian and response at an ambient body.
void scaleSide(const RigidSide& side, btScalar factor) {
  if (!side.ambient) return;
  side.jacobian.angular *= factor;
  side.jacobian.linear *= factor;
  side.jacobian.angular_component *= factor;
}

bool isLocked(const RigidSide& side) { return side.ambient && side.ambient->is_locked; }

// Switches off a row that acts along locked axes only. The row stays in its pool, and
// complementarity solvers divide by its diagonal entry, which therefore keeps its value without
// fluid, `old_denominator`.
void suspendRow(btSolverConstraint& row, const RigidSide& a, const RigidSide& b,
                btScalar old_denominator) {
  const btScalar found = pointAlongLockedAxes(a) + pointAlongLockedAxes(b);
  const btScalar factor = found > 0 ? btSqrt(old_denominator / found) : btScalar(0);
  scaleSide(a, factor);
  scaleSide(b, factor);
  row.m_rhs = row.m_rhsPenetration = row.m_cfm = 0;
}

// Returns |P J_l|^2 / m, where P projects on the locked axes: the response along locked axes that
// Bullet's effective mass contains and the body does not have.
btScalar lockedResponse(const RigidSide& side) {
  if (!side.ambient) return 0;
  return (side.jacobian.linear * side.ambient->locked_linear).length2() *
         side.ambient->inverse_mass;
}

// Returns the relaxation factor of a row whose bodies have locked axes, above 0 and at most 1: the
// share of free axes in `old_denominator`, the inverse of Bullet's effective mass, which knows no
// locks. A row almost along a locked axis has a small response; without this factor its large
// impulse would throw the body about.
btScalar lockedRelaxation(const RigidSide& a, const RigidSide& b, btScalar old_denominator) {
  const btScalar share = 1 - (lockedResponse(a) + lockedResponse(b)) / old_denominator;
  return btMax(share, kNoResponse);
}

AMBIENT_INLINE void rewriteRow(btSolverConstraint& row, RowKind kind, const RigidSide& a,
                               const RigidSide& b, btScalar relaxation) {
  const btScalar old_inverse = row.m_jacDiagABInv;
  if (!(old_inverse > 0)) {  // Bullet has switched it off: its Jacobian is as good as zero
    inverseEffectiveMass(a, b);
    return;
  }
  // Contact rows hold their softness inside the effective mass, all others apart from it.
  const bool is_soft = kind == RowKind::kContact && row.m_cfm != 0;
  const btScalar cfm = is_soft ? row.m_cfm / old_inverse : btScalar(0);
  btScalar share = 1;
  if (isLocked(a) || isLocked(b)) {
    const btScalar old_denominator = relaxation / old_inverse - cfm;
    share = lockedRelaxation(a, b, old_denominator);
    if (!(responseOf(a) + responseOf(b) > kNoResponse * old_denominator)) {
      suspendRow(row, a, b, old_denominator);
      return;
    }
  }
  const btScalar unseen = unseenChange(kind, a, b);
  const btScalar new_inverse = share * relaxation / (inverseEffectiveMass(a, b) + cfm);
  const btScalar ratio = new_inverse / old_inverse;
  row.m_jacDiagABInv = new_inverse;
  // Rescales by the ratio and does not recompute: spring rows may hold infinite right-hand sides.
  row.m_rhs = row.m_rhs * ratio - unseen * new_inverse;
  if (kind == RowKind::kContact) {
    row.m_rhsPenetration *= ratio;
    row.m_cfm = cfm * new_inverse;
  }
}

AMBIENT_INLINE void rewriteAll(btConstraintArray& rows, RowKind kind, btScalar relaxation,
                               RowBodies& bodies,
                               const btAlignedObjectArray<btSolverBody>& solver_bodies) {
  for (int i = 0; i < rows.size(); ++i) {
    btSolverConstraint& row = rows[i];
    // The multithreaded solver leaves rows of torsional friction that it does not need unset.
    if (kind == RowKind::kTorsionalFriction && row.m_frictionIndex < 0) continue;
    RowBody* a = bodies.find(row.m_solverBodyIdA);
    RowBody* b = bodies.find(row.m_solverBodyIdB);
    if (!a && !b) continue;
    const RowJacobian jacobian_a{row.m_relpos1CrossNormal, row.m_contactNormal1,
                                 row.m_angularComponentA};
    const RowJacobian jacobian_b{row.m_relpos2CrossNormal, row.m_contactNormal2,
                                 row.m_angularComponentB};
    rewriteRow(row, kind, {a, solver_bodies[row.m_solverBodyIdA], jacobian_a},
               {b, solver_bodies[row.m_solverBodyIdB], jacobian_b}, relaxation);
    ++(a ? a : b)->rows;
  }
}

}  // namespace

void RowBodies::reset(int solver_body_count) {
  bodies_.clear();
  index_.assign(solver_body_count, -1);
}

RowBody& RowBodies::add(int solver_body) {
  AMBIENT_ASSERT(solver_body >= 0 && !find(solver_body));
  index_[solver_body] = static_cast<int>(bodies_.size());
  return bodies_.emplace_back();
}

btScalar changeBasis(const RowBody& body, const RowJacobian& jacobian) noexcept {
  changedProducts(body, jacobian);
  return diagonal(body, jacobian);
}

btScalar inverseEffectiveMass(const btSolverBody& body, const RowJacobian& jacobian) noexcept {
  return jacobian.linear.dot(jacobian.linear * body.internalGetInvMass()) +
         jacobian.angular.dot(jacobian.angular_component);
}

void rewriteRows(btConstraintArray& rows, RowKind kind, btScalar relaxation, RowBodies& bodies,
                 const btAlignedObjectArray<btSolverBody>& solver_bodies) noexcept {
  static const auto rewrite = fastestCopy<&rewriteAll>();
  rewrite(rows, kind, relaxation, bodies, solver_bodies);
}

namespace {

// Largest motion across a push relative to the motion, that needs no second row: it lets a body
// creep down a slope by a millimetre in ten seconds, and one that is turned in a current by a
// millimetre in a minute.
constexpr double kLeastAnisotropy = 1e-3;

}  // namespace

bool isInFrictionCone(const btVector3& push_W, const btVector3& normal_W,
                      btScalar friction) noexcept {
  constexpr btScalar kFlat = btScalar(0.01);
  const btScalar pressed = -push_W.dot(normal_W);
  const btScalar along = (push_W + pressed * normal_W).length();
  return along > kFlat * pressed && along <= friction * pressed;
}

bool isTurnedInFrictionCone(const btSolverConstraint& contact, const btVector3& push_W,
                            const btVector3& normal_W, RowBodies& bodies) noexcept {
  const auto turned = [&](int id, const btVector3& arm) {
    const RowBody* const body = bodies.find(id);
    return body ? btFabs(body->spin_to_hold.dot(normal_W)) * arm.length() : btScalar(0);
  };
  const btScalar pressed = -push_W.dot(normal_W);
  const btScalar along = turned(contact.m_solverBodyIdA, contact.m_relpos1CrossNormal) +
                         turned(contact.m_solverBodyIdB, contact.m_relpos2CrossNormal);
  return along > btScalar(kLeastAnisotropy) * pressed && along <= contact.m_friction * pressed;
}

bool mayDeflect(const AmbientBody& ambient) noexcept {
  if (ambient.surface()) return true;
  const BodyModel& model = ambient.model();
  const Vector3 response = model.inverse_inertia.diagonal().tail<3>();
  return !model.has_diagonal_inertia ||
         response.maxCoeff() - response.minCoeff() > kLeastAnisotropy * response.minCoeff();
}

bool deflects(const AmbientBody& ambient, const btVector3& normal_W) noexcept {
  const BodyModel& model = ambient.model();
  if (ambient.surface() || !model.has_diagonal_inertia) return true;
  const btMatrix3x3& rotation = ambient.body->getWorldTransform().getBasis();
  const Vector3 normal = toVector3(normal_W * rotation);  // in B
  const Vector3 push = model.inverse_inertia.diagonal().tail<3>().cwiseProduct(normal);
  return push.cross(normal).squaredNorm() >
         kLeastAnisotropy * kLeastAnisotropy * push.squaredNorm();
}

namespace {

// Returns ds, the change of the row's impulse before it is limited.
AMBIENT_INLINE btScalar lackingImpulse(const btSolverBody& a, const btSolverBody& b,
                                       const btSolverConstraint& row) {
  const Four along = sumsOfThree(load(row.m_contactNormal1) * load(a.m_deltaLinearVelocity),
                                 load(row.m_relpos1CrossNormal) * load(a.m_deltaAngularVelocity),
                                 load(row.m_contactNormal2) * load(b.m_deltaLinearVelocity),
                                 load(row.m_relpos2CrossNormal) * load(b.m_deltaAngularVelocity));
  const btScalar j = row.m_jacDiagABInv;
  btScalar lacking = row.m_rhs - btScalar(row.m_appliedImpulse) * row.m_cfm;
  lacking -= (along[0] + along[1]) * j;
  lacking -= (along[2] + along[3]) * j;
  return lacking;
}

template <bool kHasUpperLimit>
AMBIENT_INLINE btScalar solve(btSolverBody& a, btSolverBody& b, const btSolverConstraint& row) {
  btScalar impulse = lackingImpulse(a, b, row);
  const btScalar applied = row.m_appliedImpulse;
  btScalar sum = applied + impulse;
  if (sum < row.m_lowerLimit) {
    sum = row.m_lowerLimit;
    impulse = sum - applied;
  } else if (kHasUpperLimit && sum > row.m_upperLimit) {
    sum = row.m_upperLimit;
    impulse = sum - applied;
  }
  row.m_appliedImpulse = sum;
  applyImpulse(a, row.m_contactNormal1, row.m_angularComponentA, impulse);
  applyImpulse(b, row.m_contactNormal2, row.m_angularComponentB, impulse);
  return static_cast<btScalar>(static_cast<double>(impulse) *
                               (1. / static_cast<double>(row.m_jacDiagABInv)));
}

AMBIENT_INLINE btScalar solveIn(const RowPass& pass, const btSolverConstraint& row,
                                bool has_upper_limit, btScalar largest) {
  btSolverBody &a = pass.bodies[row.m_solverBodyIdA], &b = pass.bodies[row.m_solverBodyIdB];
  const btScalar residual = has_upper_limit ? solve<true>(a, b, row) : solve<false>(a, b, row);
  return btMax(largest, residual * residual);
}

AMBIENT_INLINE btScalar solveJoints(const RowPass& pass, int iteration, btScalar largest) {
  for (int i = 0; i < pass.rows.size(); ++i) {
    const btSolverConstraint& row = pass.rows[pass.order[i]];
    if (iteration < row.m_overrideNumSolverIterations) largest = solveIn(pass, row, true, largest);
  }
  return largest;
}

AMBIENT_INLINE btScalar solveContacts(const RowPass& pass, btScalar largest) {
  for (int i = 0; i < pass.rows.size(); ++i)
    largest = solveIn(pass, pass.rows[pass.order[i]], false, largest);
  return largest;
}

AMBIENT_INLINE btScalar solveFrictions(const RowPass& pass, const btConstraintArray& contacts,
                                       btScalar largest) {
  for (int i = 0; i < pass.rows.size(); ++i) {
    btSolverConstraint& row = pass.rows[pass.order[i]];
    const btScalar pressed = contacts[row.m_frictionIndex].m_appliedImpulse;
    if (!(pressed > 0)) continue;
    row.m_lowerLimit = -(row.m_friction * pressed);
    row.m_upperLimit = row.m_friction * pressed;
    largest = solveIn(pass, row, true, largest);
  }
  return largest;
}

}  // namespace

const QuickRows& quickRows() noexcept {
  static const QuickRows fastest{fastestCopy<&solve<true>>(), fastestCopy<&solve<false>>(),
                                 fastestCopy<&solveContacts>(), fastestCopy<&solveFrictions>(),
                                 fastestCopy<&solveJoints>()};
  return fastest;
}

AMBIENT_END
