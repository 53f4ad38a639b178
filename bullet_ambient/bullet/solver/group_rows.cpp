// Prepares the ambient bodies of a group for constraint rows: velocity that rows are solved
// against, velocity basis, locked axes. Ends the solver's work on them: maps velocity changes by
// rows back, lets bodies fly that no row has moved.

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/rows/joint_rows.h"
#include "bullet_ambient/bullet/solver/solver_group.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/wrench_sensor.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
namespace {

// Returns the inertia that rows move, in B.
const Matrix6& rowInertia(const BodyModel& model, const RowVelocity& row) {
  return row.settled_inertia ? *row.settled_inertia : model.inertia;
}

// Returns the velocity basis T in body axes, docs/theory.md eq. (26). It is computed anew at a
// water surface and where the fluid settles the body, because the inertia changes from step to
// step.
Matrix6 basisOf(const AmbientBody& ambient, const BodyModel& model, const RowVelocity& row) {
  if (!ambient.surface() && !row.settled_inertia) return ambient.in_medium->basis_B;
  const Vector3 inverse_inertia = toVector3(ambient.body->getInvInertiaDiagLocal());
  return makeVelocityBasis(rowInertia(model, row), model.mass, inverse_inertia.cwiseInverse());
}

// Returns 1 for each component that is zero, else 0.
btVector3 whereZero(const btVector3& v) {
  return {btScalar(v.x() == 0), btScalar(v.y() == 0), btScalar(v.z() == 0)};
}

// Sets the basis of eq. (30) and Bullet's factors of locked axes to 1: T contains the locks, which
// the solver must not apply twice. `R`: B to W.
void lock(RowBody& row_body, const btRigidBody& body, const Matrix6& row_inertia, const Matrix3& R,
          btSolverBody& solver_body) {
  const Vector3 inertia = toVector3(body.getInvInertiaDiagLocal()).cwiseInverse();
  const Matrix3 root = rootInertia(inertia, R);
  row_body.is_locked = true;
  row_body.basis = makeLockedBasis(row_inertia, 1 / static_cast<double>(body.getInvMass()), root, R,
                                   axisFactors(body));
  row_body.root_inertia = toBulletMatrix(root);
  row_body.locked_angular = whereZero(body.getAngularFactor());
  row_body.locked_linear = whereZero(body.getLinearFactor());
  solver_body.m_angularFactor.setValue(1, 1, 1);
  solver_body.m_linearFactor.setValue(1, 1, 1);
  solver_body.internalSetInvMass(btVector3(1, 1, 1) * body.getInvMass());
}

// Finds the flotations of the bodies at a water surface, side by side.
void updateAllFlotations(AmbientBody* const* bodies, const RigidState* states, int count,
                         double time_step, Warnings& warnings) {
  AmbientBody* at_surface[kFlightsTogether] = {};
  RigidState there[kFlightsTogether];
  int found = 0;
  for (int i = 0; i < count; ++i) {
    if (!bodies[i]->surface()) continue;
    at_surface[found] = bodies[i];
    there[found++] = states[i];
  }
  if (found == 0) return;
  updateFlotations(at_surface, there, found, kBulletRounding);
  for (int i = 0; i < found; ++i) warnOfShortPeriod(*at_surface[i], time_step, warnings);
}

// Leaves a body of revolution at a surface its spin about its axis, docs/theory.md eq. (66a).
// `start`: pose of B.
void keepSpin(const SurfaceModel& model, const RigidState& start, RowVelocity& row) {
  const Vector3 axis_W = start.orientation * model.still_axis_B;
  const Vector3 spin_W = axis_W.dot(row.turning_W.angular) * axis_W;
  row.turning_W.angular -= spin_W;
  row.change_W.angular -= spin_W;
}

// Shortens the way of a body at a surface to where its energy reaches, docs/theory.md eq. (68c).
void keepWithinReach(AmbientBody& ambient, const RigidState& start, const Surroundings& s,
                     double time_step, RowVelocity& row) {
  Twist change_W = row.change_W;
  change_W.linear -= time_step * s.ambient_acceleration;
  const Vector6 end = ambient.floating->twist_before_rows +
                      turned(start.orientation.conjugate(), change_W).vector();
  const double part = reachWithRows(ambient, start, s, time_step, end);
  if (part == 1) return;
  const Twist less_W = onFreeAxes(turned(start.orientation, Twist::fromVector((1 - part) * end)),
                                  axisFactors(*ambient.body));
  row.change_W = Twist::fromVector(row.change_W.vector() - less_W.vector());
  row.turning_W = Twist::fromVector(part * row.turning_W.vector());
  ++ambient.counters.halted;
}

// Adds the kicks by waves, wind and water that comes in to a velocity change, and counts what it
// cost. Sets it to zero if it is not finite. `inertia`: of the free body, in B.
void complete(AmbientBody& ambient, const Matrix6& inertia, const RigidState& start,
              const Surroundings& s, double time_step, Warnings& warnings, RowVelocity& row) {
  if (ambient.surface()) {
    const AxisFactors factors = axisFactors(*ambient.body);
    if (factors.areFree()) keepSpin(*ambient.surface(), start, row);
    RigidState now = readState(*ambient.body);
    const auto kick = [&](const Vector6& change_B) {
      const Twist change_W =
          factors.areFree()
              ? turned(start.orientation, Twist::fromVector(change_B))
              : lockedChange(inertia, start.orientation.toRotationMatrix(), factors, change_B);
      row.change_W.angular += change_W.angular;
      row.change_W.linear += change_W.linear;
      return turned(start.orientation.conjugate(), change_W).vector();
    };
    if (ambient.vessel)
      now.twist = Twist::fromVector(now.twist.vector() + kick(ambient.vessel->change_B));
    kick(kickByWavesAndWind(ambient, now, time_step));
    keepWithinReach(ambient, start, s, time_step, row);
  }
  countLoads(ambient, row.count.load_evaluations);
  ambient.counters.guarded += row.count.guarded;
  if (row.change_W.vector().allFinite()) return;
  ++ambient.counters.rejected;
  warnings.warnOnce(Warning::kNotFinite);
  row.change_W = row.turning_W = row.isotropic_excess_W = {};
  row.settled_inertia.reset();
}

// Returns true unless all contacts of a body have restitution 0; a callback may set any.
bool mayBounce(const btRigidBody& body) {
  return body.getRestitution() != 0 || gContactAddedCallback != nullptr;
}

// Returns the part of a body's velocity change by surface loads, in W. `row`: before complete().
Twist changeByLoad(const btRigidBody& body, const FlightTask& task, const Quaternion& orientation,
                   const RowVelocity& row) {
  const double dt = task.duration;
  const Surroundings& s = task.surroundings;
  const Matrix3 R = orientation.toRotationMatrix();
  const Vector6 forced =
      dt * (task.model.inverse_inertia * externalWrench(task.model, s, R).vector());
  const Twist by_forces = lockedChange(task.model.inertia, R, axisFactors(body), forced);
  const Twist accelerated = onFreeAxes({{0, 0, 0}, dt * s.ambient_acceleration}, axisFactors(body));
  return Twist::fromVector(row.change_W.vector() - row.turning_W.vector() - by_forces.vector() -
                           accelerated.vector());
}

// Writes what FlightKernel::conserve() reads of a body that starts a step so.
void setConserved(const RigidState& start, const RowVelocity& row, double time_step, int lane,
                  RowBatch& batch) {
  RowLanes& lanes = batch.lanes;
  batch.positions[lane] = start.position;
  batch.settled_inertia[lane] = row.settled_inertia;
  lanes.kick_time[lane] = time_step;
  lanes.turn_number[lane] = row.turn_number;
  setLane(lanes.orientation, lane, start.orientation);
  setLane(lanes.turning_W, lane, row.turning_W);
}

// Fills what rows need of a body at the orientation R, B to W. @pre the body's inertia tensor fits
// it
void fillRowBody(const AmbientBody& ambient, const BodyModel& model, const Matrix3& R,
                 const RowVelocity& row, const btSolverBody& solver_body, RowBody& row_body) {
  const btRigidBody& body = *ambient.body;
  row_body.inverse_inertia_T = body.getInvInertiaTensorWorld().transpose();
  row_body.inverse_mass = body.getInvMass();
  row_body.spin_change = solver_body.m_externalTorqueImpulse;
  row_body.velocity_change = solver_body.m_externalForceImpulse;
  row_body.spin_excess = toBullet(row.isotropic_excess_W.angular);
  row_body.velocity_excess = toBullet(row.isotropic_excess_W.linear);
  const btVector3 half_turn = toBullet(row.turning_W.angular);
  const btVector3 push = row_body.spin_change + row_body.spin_excess + half_turn;
  if ((solver_body.m_angularVelocity - half_turn).length2() < push.length2())
    row_body.spin_to_hold = push;
  if (row_body.is_locked) return;
  const bool is_diagonal = model.has_diagonal_inertia;
  const Matrix6 basis_B = basisOf(ambient, model, row);
  row_body.has_coupling = !is_diagonal;
  row_body.basis = is_diagonal ? toWorld(Vector6(basis_B.diagonal()), R) : toWorld(basis_B, R);
}

}  // namespace

void SolverGroup::begin() noexcept {
  const auto& solver_bodies = pools_.solver_bodies;
  may_need_second_friction_ = false;
  if (members_.empty()) {
    row_bodies_.reset(0);
    return;
  }
  member_of_solver_body_.assign(solver_bodies.size(), -1);
  row_bodies_.reset(solver_bodies.size());
  Member* waiting[kFlightsTogether] = {};
  int count = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& member = members_[i];
    member.solver_body = member.ambient->body->getCompanionId();
    AMBIENT_ASSERT(member.solver_body >= 0 && member.solver_body < solver_bodies.size());
    member_of_solver_body_[member.solver_body] = static_cast<int>(i);
    if (!member.has_rows && !member.is_locked) {
      setExternalImpulse(pools_.solver_bodies[member.solver_body], Twist{});
      continue;
    }
    may_need_second_friction_ = may_need_second_friction_ || mayDeflect(*member.ambient);
    waiting[count++] = &member;
    if (count == kFlightsTogether) prepareForRows(waiting, std::exchange(count, 0));
  }
  if (count > 0) prepareForRows(waiting, count);
}

void SolverGroup::prepareForRows(Member* const* members, int count) noexcept {
  AMBIENT_ASSERT(batch_count_ < batches_.size());
  RowBatch& batch = batches_[batch_count_++];
  RowLanes& lanes = batch.lanes;
  batch.count = count;
  for (int i = 0; i < count; ++i) {
    batch.bodies[i] = members[i]->ambient;
    batch.solver_bodies[i] = members[i]->solver_body;
    AMBIENT_ASSERT(batch.bodies[i]->body->getInvMass() > 0);
    // T must fit the inertia tensor; Bullet's setWorldTransform leaves that of the old orientation.
    batch.bodies[i]->body->updateInertiaTensor();
  }
  StartStates starts;
  readStartStates(batch.bodies, count, starts);
  updateAllFlotations(batch.bodies, starts.states, count, time_step_, bodies_.warnings);
  std::optional<StepModel> step_models[kFlightsTogether];
  const BodyModel* models[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i)
    models[i] = &*step_models[i].emplace(*batch.bodies[i], time_step_);
  setModels(models, count, lanes);
  const auto taskOf = [&](int i) -> FlightTask {
    return {*models[i], starts.surroundings[i], batch.bodies[i]->def->flight, time_step_};
  };
  RowLoad loads[kFlightsTogether];
  bool is_any_free = false;
  for (int i = 0; i < count; ++i) {
    batch.loads_W[i] = {};
    if (members[i]->is_locked) continue;
    loads[i] = setStart(taskOf(i), starts.states[i], batch.bodies[i]->outcome.lastLoad(), i, lanes);
    batch.loads_W[i] = loads[i].mean_W;
    is_any_free = true;
  }
  if (is_any_free) kFlightKernels.fastest()->predictRowVelocity(lanes);
  for (int i = 0; i < count; ++i) {
    const Member& member = *members[i];
    AmbientBody& ambient = *member.ambient;
    const RigidState& start = starts.states[i];
    const Matrix3 R = start.orientation.toRotationMatrix();
    RowVelocity row = member.is_locked
                          ? computeLockedVelocity(taskOf(i), start, axisFactors(*ambient.body))
                          : rowVelocityOf(lanes, i, loads[i]);
    Twist by_load;
    if (models[i]->loads && mayBounce(*ambient.body))
      by_load = changeByLoad(*ambient.body, taskOf(i), start.orientation, row);
    complete(ambient, models[i]->inertia, start, starts.surroundings[i], time_step_,
             bodies_.warnings, row);
    setConserved(start, row, time_step_, i, batch);
    btSolverBody& solver_body = pools_.solver_bodies[member.solver_body];
    setExternalImpulse(solver_body, withoutTraces(row.change_W, time_step_));
    RowBody& row_body = row_bodies_.add(member.solver_body);
    row_body.is_anchored = member.is_anchored;
    if (member.is_locked)
      lock(row_body, *ambient.body, rowInertia(*models[i], row), R, solver_body);
    fillRowBody(ambient, *models[i], R, row, solver_body, row_body);
    row_body.spin_by_load = toBullet(by_load.angular);
    row_body.velocity_by_load = toBullet(by_load.linear);
  }
}

// Bodies joined to multibodies are known only once Bullet has made the rows.
void SolverGroup::prepareJoinedToMultiBodies() noexcept {
  Member* waiting[kFlightsTogether] = {};
  int count = 0;
  const auto prepare = [&] {
    if (count > 0) prepareForRows(waiting, std::exchange(count, 0));
  };
  btMultiBodyConstraintArray& joints = pools_.multibodies->joints;
  for (int i = 0; i < joints.size(); ++i)
    for (const RowSide& side : sidesOf(joints[i])) {
      Member* member = memberOf(side.solver_body);
      if (!member) continue;
      member->is_anchored = true;
      if (RowBody* row_body = row_bodies_.find(side.solver_body))
        row_body->is_anchored = true;
      else if (!std::exchange(member->has_rows, true))
        waiting[count++] = member;
      if (count == kFlightsTogether) prepare();
    }
  prepare();
}

namespace {

bool isZero(const btVector3& v) { return v.x() == 0 && v.y() == 0 && v.z() == 0; }

// True if no row has changed the velocity of the body or, by split impulses, its position.
bool isUntouched(btSolverBody& b) {
  return isZero(b.internalGetDeltaLinearVelocity()) &&
         isZero(b.internalGetDeltaAngularVelocity()) && isZero(b.internalGetPushVelocity()) &&
         isZero(b.internalGetTurnVelocity());
}

// Maps a velocity change from the basis T to world axes, in place.
void fromBasis(const WorldBasis& T, btVector3& angular, btVector3& linear) {
  angular = T.angular * angular + T.coupling * linear;
  linear = T.linear * linear;
}

// True if the velocity and the position correction that Bullet will write back are finite.
bool isFinite(btSolverBody& b) {
  return solvedVelocity(b).vector().allFinite() &&
         toVector3(b.internalGetPushVelocity()).allFinite() &&
         toVector3(b.internalGetTurnVelocity()).allFinite();
}

// Sets all changes by rows and forces to zero.
void dropRows(btSolverBody& b) {
  for (btVector3* change :
       {&b.internalGetDeltaLinearVelocity(), &b.internalGetDeltaAngularVelocity(),
        &b.internalGetPushVelocity(), &b.internalGetTurnVelocity(), &b.m_externalForceImpulse,
        &b.m_externalTorqueImpulse})
    change->setZero();
}

// Maps the velocity changes by rows to world axes. Returns false, and drops the changes, if they
// are not finite.
bool finishRows(AmbientBody& ambient, const RowBody& row_body, btSolverBody& b) {
  const bool is_untouched = isUntouched(b);
  ambient.outcome.kind = is_untouched ? Outcome::kNoFlight : Outcome::kRows;
  ambient.outcome.motion = RowMotion{};
  if (!is_untouched) {
    fromBasis(row_body.basis, b.internalGetDeltaAngularVelocity(),
              b.internalGetDeltaLinearVelocity());
    fromBasis(row_body.basis, b.internalGetTurnVelocity(), b.internalGetPushVelocity());
  }
  if (ambient.surface()) ambient.floating->waves = ambient.floating->waves_with_rows;
  if (!isFinite(b)) {
    dropRows(b);
    ++ambient.counters.rejected;
    return false;
  }
  return true;
}

}  // namespace

void SolverGroup::finish(const btContactSolverInfo& info) noexcept {
  auto& solver_bodies = pools_.solver_bodies;
  joint_errors_->measure(pools_, row_bodies_, time_step_);
  restoreFeedbackJacobians();
  if (is_disabled_)
    for (int i = 0; i < solver_bodies.size(); ++i) dropRows(solver_bodies[i]);
  for (const Member& member : members_) {
    // Every body that a row has moved has a RowBody since begin() or rewriteRows().
    if (row_bodies_.find(member.solver_body)) continue;
    AMBIENT_ASSERT(isUntouched(solver_bodies[member.solver_body]));
    flyLater({member.ambient, &solver_bodies[member.solver_body]});
  }
  for (std::size_t i = 0; i < batch_count_; ++i)
    finishBatch(batches_[i], static_cast<double>(info.m_splitImpulseTurnErp));
  flyFreely();
  members_.clear();
  batch_count_ = 0;
}

// Ends the work on bodies that rows may have moved: flies those that none has moved, and prepares
// the motion of the others, eq. (31).
void SolverGroup::finishBatch(RowBatch& batch, double turn_share) noexcept {
  auto& solver_bodies = pools_.solver_bodies;
  bool is_any_moved = false;
  for (int i = 0; i < batch.count; ++i) {
    const int id = batch.solver_bodies[i];
    AmbientBody& ambient = *batch.bodies[i];
    const RowBody& row_body = *row_bodies_.find(id);
    btSolverBody& solver_body = solver_bodies[id];
    ambient.counters.rows += row_body.rows;
    ambient.counters.joint_rows += row_body.joint_rows;
    noteJointError(ambient, row_body);
    // Rows were solved against the velocity k + X of eq. (28). In a fast turn the flight goes
    // elsewhere, and could pass through what the rows keep apart.
    const bool may_fly = !row_body.is_locked && batch.lanes.turn_number[i] <= kSlowTurn;
    bool is_moved = false;
    if (may_fly && isUntouched(solver_body)) {
      flyLater({&ambient, &solver_body});
    } else if (finishRows(ambient, row_body, solver_body)) {
      is_moved = true;
    } else {
      bodies_.warnings.warnOnce(Warning::kNotFinite);
    }
    batch.lanes.active[i] = is_moved;
    is_any_moved = is_any_moved || is_moved;
  }
  if (!is_any_moved) return;
  beginRowMotions(batch, row_bodies_, solver_bodies, turn_share, time_step_);
  for (int i = 0; i < batch.count; ++i)
    if (batch.lanes.active[i] != 0 && batch.bodies[i]->sensor)
      readRows(*batch.bodies[i], changeByRows(solver_bodies[batch.solver_bodies[i]]),
               batch.settled_inertia[i], time_step_);
}

// Counts the steps in a row in which a joint of the body misses by more than kLargeJointError of
// its size. Reports the body after kStepsToReport steps.
void SolverGroup::noteJointError(AmbientBody& ambient, const RowBody& row_body) noexcept {
  const double size = ambient.metric().reference_length;
  const bool is_open = size > 0 && row_body.joint_error > kLargeJointError * size;
  constexpr int kMostSteps = 1000;
  ambient.open_joint_steps =
      static_cast<std::int16_t>(is_open ? std::min(ambient.open_joint_steps + 1, kMostSteps) : 0);
  if (ambient.open_joint_steps != kStepsToReport) return;
  const Member* other = memberOf(row_body.joined_to);
  bodies_.warnings.warnOfOpenJoint(*ambient.def, other ? other->ambient->def.get() : nullptr);
}

AMBIENT_END
