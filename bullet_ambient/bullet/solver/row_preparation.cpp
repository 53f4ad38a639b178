// Prepares the ambient bodies of a group for constraint rows: velocity that rows are solved
// against, velocity basis, locked axes.
#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/links/multibody_rows.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"
#include "bullet_ambient/bullet/rows/slope_friction.h"
#include "bullet_ambient/bullet/solver/external_impulse.h"
#include "bullet_ambient/bullet/solver/solver_group.h"
#include "bullet_ambient/immersed/surface_encounter.h"
#include "bullet_ambient/motion/flight/axis_locks.h"
#include "bullet_ambient/motion/flight/row_velocity.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
namespace {

// Returns the velocity basis T in body axes, docs/theory.md eq. (26). At a water surface it is
// computed anew, because the inertia changes from step to step.
Matrix6 basisOf(const AmbientBody& ambient, const BodyModel& model) {
  if (!ambient.surface()) return ambient.in_medium->basis_B;
  const Vector3 inverse_inertia = toVector3(ambient.body->getInvInertiaDiagLocal());
  return makeVelocityBasis(model, inverse_inertia.cwiseInverse());
}

// Returns 1 for each component that is zero, else 0.
btVector3 whereZero(const btVector3& v) {
  return {btScalar(v.x() == 0), btScalar(v.y() == 0), btScalar(v.z() == 0)};
}

// Sets the basis of eq. (30) and Bullet's factors of locked axes to 1: T contains the locks, which
// the solver must not apply twice.
void lock(RowBody& row_body, const btRigidBody& body, const FlightTask& task,
          const AxisFactors& factors, btSolverBody& solver_body) {
  const Vector3 inertia = toVector3(body.getInvInertiaDiagLocal()).cwiseInverse();
  const Matrix3 R = readState(body).orientation.toRotationMatrix();
  const Matrix3 root = rootInertia(inertia, R);
  row_body.is_locked = true;
  row_body.basis = makeLockedBasis(task.model, root, R, factors);
  row_body.root_inertia = toBulletMatrix(root);
  row_body.locked_angular = whereZero(body.getAngularFactor());
  row_body.locked_linear = whereZero(body.getLinearFactor());
  solver_body.m_angularFactor.setValue(1, 1, 1);
  solver_body.m_linearFactor.setValue(1, 1, 1);
  solver_body.internalSetInvMass(btVector3(1, 1, 1) * body.getInvMass());
}

// Returns the velocity change that rows are solved against, eq. (28), with the kicks by waves and
// wind; zero if it is not finite. @pre the body's inertia tensor fits its orientation
RowVelocity velocityForRows(AmbientBody& ambient, const RigidState& start,
                            const AxisFactors& factors, const FlightTask& task,
                            Complaints& complaints) {
  RowVelocity row = factors.areFree() ? computeRowVelocity(task, start)
                                      : computeLockedVelocity(task, start, factors);
  if (ambient.surface()) {
    const Vector6 by_surface = kickByWavesAndWind(ambient, task.duration);
    const Twist kick_W = turned(start.orientation, Twist::fromVector(by_surface));
    row.change_W.angular += kick_W.angular;
    row.change_W.linear += kick_W.linear;
  }
  countLoads(ambient, row.count.load_evaluations);
  ambient.counters.guarded += row.count.guarded;
  if (!row.change_W.vector().allFinite()) {
    ++ambient.counters.rejected;
    complaints.say(Complaint::kNotFinite);
    row.change_W = row.turning_W = row.isotropic_excess_W = {};
  }
  return row;
}

}  // namespace

void SolverGroup::begin(SolverBodies& solver_bodies) noexcept {
  may_hold_slopes_ = false;
  if (members_.empty()) {
    row_bodies_->reset(0);
    return;
  }
  member_of_solver_body_.assign(solver_bodies.size(), -1);
  row_bodies_->reset(solver_bodies.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& member = members_[i];
    member.solver_body = member.object->getCompanionId();
    AMBIENT_ASSERT(member.solver_body >= 0 && member.solver_body < solver_bodies.size());
    member_of_solver_body_[member.solver_body] = static_cast<int>(i);
    btSolverBody& solver_body = solver_bodies[member.solver_body];
    if (member.has_rows || member.is_locked) {
      may_hold_slopes_ = may_hold_slopes_ || mayTurnAside(*member.ambient);
      prepareForRows(member, solver_body);
    } else {
      setExternalImpulse(solver_body, Twist{});
    }
  }
}

void SolverGroup::prepareForRows(Member& member, btSolverBody& solver_body) noexcept {
  AmbientBody& ambient = *member.ambient;
  AMBIENT_ASSERT(ambient.body->getInvMass() > 0);
  // T must fit the inertia tensor; Bullet's setWorldTransform leaves that of the old orientation.
  ambient.body->updateInertiaTensor();
  const btRigidBody& body = *ambient.body;
  const RigidState start = readState(body);
  const AxisFactors factors = axisFactors(body);
  if (ambient.surface()) {
    standNow(ambient);
    warnOfCoarseSwing(ambient, time_step_, bodies_.complaints);
  }
  const StepModel model(ambient, time_step_);
  const Surroundings surroundings = readSurroundings(ambient);
  const FlightTask task{*model, surroundings, ambient.def->flight, time_step_};
  const RowVelocity row = velocityForRows(ambient, start, factors, task, bodies_.complaints);
  setExternalImpulse(solver_body, withoutTraces(row.change_W, time_step_));

  RowBody& row_body = row_bodies_->add(member.solver_body);
  row_body.start = start;
  row_body.turning_W = row.turning_W;
  row_body.extent = row.extent;
  row_body.is_held = member.is_held;
  row_body.inverse_inertia_T = body.getInvInertiaTensorWorld().transpose();
  row_body.inverse_mass = body.getInvMass();
  row_body.spin_change = solver_body.m_externalTorqueImpulse;
  row_body.velocity_change = solver_body.m_externalForceImpulse;
  row_body.spin_aside = toBullet(row.isotropic_excess_W.angular);
  row_body.velocity_aside = toBullet(row.isotropic_excess_W.linear);
  if (member.is_locked) {
    lock(row_body, body, task, factors, solver_body);
  } else {
    const Matrix3 R = start.orientation.toRotationMatrix();
    const bool is_diagonal = model->has_diagonal_inertia;
    row_body.has_coupling = !is_diagonal;
    row_body.basis = is_diagonal ? toWorld(Vector6(ambient.in_medium->basis_B.diagonal()), R)
                                 : toWorld(basisOf(ambient, *model), R);
  }
}

void SolverGroup::prepareJoinedToMultiBodies(SolverBodies& solver_bodies,
                                             const btMultiBodyConstraintArray& joints) noexcept {
  forEachJoinedBody(joints, [&](int id) {
    Member* member = memberOf(id);
    if (!member) return;
    if (!row_bodies_->find(id)) prepareForRows(*member, solver_bodies[id]);
    row_bodies_->find(id)->is_held = true;
  });
}

AMBIENT_END
