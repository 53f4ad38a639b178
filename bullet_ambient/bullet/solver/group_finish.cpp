// Ends the solver's work on a group: maps velocity changes by rows back, flies bodies that no row
// has moved.
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/rows/joint_gaps.h"
#include "bullet_ambient/bullet/rows/row_motion.h"
#include "bullet_ambient/bullet/rows/row_rewriting.h"
#include "bullet_ambient/bullet/solver/solver_group.h"
#include "bullet_ambient/immersed/fluid_reading.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/threads.h"

AMBIENT_BEGIN
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
  const btVector3 linear =
      b.m_linearVelocity + b.internalGetDeltaLinearVelocity() + b.m_externalForceImpulse;
  const btVector3 angular =
      b.m_angularVelocity + b.internalGetDeltaAngularVelocity() + b.m_externalTorqueImpulse;
  return toVector3(linear).allFinite() && toVector3(angular).allFinite() &&
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
  const bool is_adrift = isUntouched(b);
  ambient.outcome.kind = is_adrift ? Outcome::kAdrift : Outcome::kRows;
  ambient.outcome.motion = RowMotion{};
  if (!is_adrift) {
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

// Task that calls fly(item). Keeps a reference to `fly` and allocates nothing.
template <class Fly>
class FlightTasks final : public Task {
 public:
  explicit FlightTasks(const Fly& fly) : fly_(fly) {}
  void run(int item) const noexcept override { fly_(item); }

 private:
  const Fly& fly_;
};

}  // namespace

void SolverGroup::finish(SolverBodies& solver_bodies, btConstraintArray& joints,
                         const btContactSolverInfo& info) noexcept {
  joint_gaps_->measure(joints, *row_bodies_, solver_bodies, time_step_);
  restoreFeedbackJacobians(joints);
  if (is_held_)
    for (int i = 0; i < solver_bodies.size(); ++i) dropRows(solver_bodies[i]);
  for (const Member& member : members_) {
    // Every body that a row has moved has a RowBody since begin() or rewriteRows().
    if (row_bodies_->find(member.solver_body)) continue;
    AMBIENT_ASSERT(isUntouched(solver_bodies[member.solver_body]));
    flyLater({member.ambient, member.solver_body}, &solver_bodies);
  }
  for (std::size_t i = 0; i < batch_count_; ++i)
    finishBatch(batches_[i], static_cast<double>(info.m_splitImpulseTurnErp), solver_bodies);
  flyFreely(&solver_bodies);
  members_.clear();
  batch_count_ = 0;
}

// Ends the work on bodies that rows may have moved: flies those that none has moved, and prepares
// the motion of the others, eq. (31).
void SolverGroup::finishBatch(RowBatch& batch, double turn_share,
                              SolverBodies& solver_bodies) noexcept {
  bool is_any_moved = false;
  for (int i = 0; i < batch.count; ++i) {
    const int id = batch.solver_bodies[i];
    AmbientBody& ambient = *batch.bodies[i];
    const RowBody& row_body = *row_bodies_->find(id);
    btSolverBody& solver_body = solver_bodies[id];
    ambient.counters.rows += row_body.rows;
    ambient.counters.joint_rows += row_body.joint_rows;
    noteGap(ambient, row_body);
    // Rows were solved against the velocity k + X of eq. (28). In a fast turn the flight goes
    // elsewhere, and could pass through what the rows keep apart.
    const bool may_fly = !row_body.is_locked && batch.lanes.extent[i] <= kSlowTurn;
    bool is_moved = false;
    if (may_fly && isUntouched(solver_body)) {
      flyLater({&ambient, id}, &solver_bodies);
    } else if (finishRows(ambient, row_body, solver_body)) {
      is_moved = true;
    } else {
      bodies_.complaints.say(Complaint::kNotFinite);
    }
    batch.lanes.active[i] = is_moved;
    is_any_moved = is_any_moved || is_moved;
  }
  if (!is_any_moved) return;
  beginRowMotions(batch, *row_bodies_, solver_bodies, turn_share, time_step_);
  for (int i = 0; i < batch.count; ++i)
    if (batch.lanes.active[i] != 0 && batch.bodies[i]->reading)
      readRows(*batch.bodies[i], changeByRows(solver_bodies[batch.solver_bodies[i]]),
               batch.settled_inertia[i], time_step_);
}

// Flies a body as soon as there are kFlightsTogether of them, while their data are in the cache; on
// several threads, when there is no further one.
void SolverGroup::flyLater(const FreeBody& body, SolverBodies* solver_bodies) noexcept {
  free_.push_back(body);
  if (!bodies_.task_runner && free_.size() == kFlightsTogether) flyFreely(solver_bodies);
}

// Flies free_. A flight changes its own body only, so that any thread may compute it.
// kFlightsTogether flights side by side are quickest on one thread; few bodies are spread over the
// threads in smaller groups. `solver_bodies`: null: Bullet converts none of the bodies.
void SolverGroup::flyFreely(SolverBodies* solver_bodies) noexcept {
  if (free_.empty()) return;
  constexpr int kLeastGroups = 8;  // groups to make before a group is filled
  const int count = static_cast<int>(free_.size());
  TaskRunner* runner = bodies_.task_runner;
  const int together =
      runner ? std::clamp(count / kLeastGroups, 1, kFlightsTogether) : kFlightsTogether;
  const auto fly = [&](int group) {
    const int first = group * together;
    flyTogether(first, std::min(together, count - first), solver_bodies);
  };
  const FlightTasks flights(fly);
  const int groups = (count + together - 1) / together;
  if (runner) {
    runner->runAll(flights, groups);
  } else {
    for (int i = 0; i < groups; ++i) flights.run(i);
  }
  for (const FreeBody& body : free_) {
    const SubstepOutcome& outcome = body.ambient->outcome;
    if (outcome.kind != Outcome::kFlown) bodies_.complaints.say(Complaint::kNotFinite);
    if (outcome.is_too_long) bodies_.complaints.sayTooLong(*body.ambient->def);
  }
  free_.clear();
}

void SolverGroup::flyTogether(int first, int count, SolverBodies* solver_bodies) const noexcept {
  AmbientBody* bodies[kFlightsTogether] = {};
  Twist changes_W[kFlightsTogether];
  const FreeBody* free = free_.data() + first;
  for (int i = 0; i < count; ++i) bodies[i] = free[i].ambient;
  Departures departures;
  readDepartures(bodies, count, departures);
  beginFlights(bodies, departures, count, time_step_, changes_W);
  for (int i = 0; i < count; ++i) {
    if (free[i].solver_body == kAlone) {
      addVelocity(*bodies[i]->body, changes_W[i]);
    } else {
      setExternalImpulse((*solver_bodies)[free[i].solver_body], changes_W[i]);
    }
  }
}

AMBIENT_END
