#include "bullet_ambient/bullet/rows/row_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/immersed/surface_encounter.h"
#include "bullet_ambient/motion/flight/row_velocity.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
namespace {

constexpr double kRounding = 16 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());

Twist changeByRows(btSolverBody& b) {
  return {toVector3(b.internalGetDeltaAngularVelocity()),
          toVector3(b.internalGetDeltaLinearVelocity())};
}

// Returns the velocity that Bullet will write back, world axes.
Twist solvedVelocity(btSolverBody& b) {
  return {toVector3(b.m_angularVelocity + b.internalGetDeltaAngularVelocity() +
                    b.m_externalTorqueImpulse),
          toVector3(b.m_linearVelocity + b.internalGetDeltaLinearVelocity() +
                    b.m_externalForceImpulse)};
}

// Returns the part of the way time_step * xi that the body has made: less than 1 if continuous
// collision detection has stopped it; none if its pose is not on this way.
std::optional<double> partOfWay(const RowMotion& rows, const RigidState& now, double time_step) {
  const RigidState& start = rows.start;
  const Vector3 velocity = rows.flow_W + start.orientation * start.twist.linear;
  const Vector3 way = time_step * velocity, gone = now.position - start.position;
  const double rounding = kRounding * (now.position.norm() + way.norm());
  double part = 1;
  if ((gone - way).norm() > rounding && way.squaredNorm() > 0)
    part = std::clamp(gone.dot(way) / way.squaredNorm(), 0.0, 1.0);
  const bool is_beside = (gone - part * way).norm() > rounding;
  const bool is_turned =
      angleBetween(start.orientation, now.orientation) > rows.turn + std::sqrt(kRounding);
  if (is_beside || is_turned) return std::nullopt;
  return part;
}

// Returns the twist farthest from `from` towards `to` whose squared norm in K is at most `bound`;
// if that of `from` is larger, `from` scaled down.
BoundedTwist withinEnergy(const BodyModel& model, const Vector6& from, const Vector6& to,
                          double bound) {
  AMBIENT_ASSERT(!(bound < 0));
  const DualPair start = pairOfTwist(model, from), step = pairOfTwist(model, to - from);
  const double excess = inner(start, start) - bound;
  const double a = inner(step, step), b = inner(start, step), removed = (a + 2 * b + excess) / 2;
  if (excess > 0) return {std::sqrt(bound / inner(start, start)) * from, std::max(0.0, removed)};
  if (!(removed > 0)) return {to};
  const double root = std::sqrt(b * b - a * excess);
  return {from + (b > 0 ? -excess / (b + root) : (root - b) / a) * (to - from), removed};
}

// Returns the twist z(w) with this spin and without linear momentum, eq. (31b).
Vector6 spinAlone(const BodyModel& model, const Vector3& spin) {
  const Matrix6& K = model.inertia;
  const Matrix3 coupling = K.bottomLeftCorner<3, 3>(), mass = K.bottomRightCorner<3, 3>();
  return stack(spin, Cholesky<3>(mass).solve(-coupling * spin));
}

// Bounds the energy of `to` at the cost of its spin, eq. (31b): keeps its linear momentum, and
// takes the spin farthest from that of `from` towards that of `to` that the bound allows. If the
// linear motion alone exceeds the bound, scales it down without spin; a held body takes
// withinEnergy().
BoundedTwist keepingMomentum(const BodyModel& model, const RowMotion& rows, const Vector6& from,
                             const Vector6& to) {
  const double bound = *rows.energy_bound;
  const Vector6 spin = spinAlone(model, to.head<3>()), straight = to - spin;
  const double energy = inertiaNormSquared(model, straight);
  if (energy > bound) {
    if (rows.is_held) return withinEnergy(model, from, to, bound);
    return {std::sqrt(bound / energy) * straight, (inertiaNormSquared(model, to) - bound) / 2};
  }
  BoundedTwist end = withinEnergy(model, spinAlone(model, from.head<3>()), spin, bound - energy);
  end.twist += straight;
  return end;
}

}  // namespace

void beginRowMotion(AmbientBody& ambient, const RowBody& row_body, btSolverBody& solver_body,
                    double time_step) noexcept {
  const StepModel step_model(ambient, time_step);
  const BodyModel& model = *step_model;
  AMBIENT_ASSERT(time_step > 0 && !(row_body.extent < 0));
  const Medium& medium = ambient.medium;
  RowMotion& rows = ambient.outcome.rows();
  rows.start = row_body.start;
  rows.is_held = row_body.is_held;
  rows.flow_W = medium.velocity + time_step * medium.acceleration;
  const Quaternion to_body = rows.start.orientation.conjugate();
  Twist relative_W = solvedVelocity(solver_body);
  relative_W.linear -= rows.flow_W;
  rows.start.twist = turned(to_body, relative_W);
  const Vector6 share = turned(to_body, row_body.turning_W).vector();
  RigidState kept = rows.start;
  kept.twist = Twist::fromVector(kept.twist.vector() - share);

  double extent = row_body.extent;
  if (!row_body.is_locked) {
    rows.momentum = worldMomentum(model, kept);
    const DualPair moved = pairOfTwist(model, rows.start.twist.vector());
    extent = std::max(extent, computeTurning(model, moved, time_step).extent);
  }
  if (extent > kSlowTurn) {
    const Vector6 by_rows = turned(to_body, changeByRows(solver_body)).vector();
    const double on_share = 2 * inner(pairOfTwist(model, share), pairOfTwist(model, by_rows));
    const double energy = inertiaNormSquared(model, kept.twist.vector()) + std::min(0.0, on_share);
    rows.energy_bound = std::max(0.0, energy);
  }
  rows.start.position += time_step * toVector3(solver_body.internalGetPushVelocity());
  rows.turn = time_step * (rows.start.twist.angular.norm() +
                           toVector3(solver_body.internalGetTurnVelocity()).norm());
}

void endRowMotion(AmbientBody& ambient, double time_step, Complaints& complaints) noexcept {
  const RowMotion& rows = ambient.outcome.rows();
  if (!rows.momentum && !rows.energy_bound && !ambient.surface()) return;
  btRigidBody& body = *ambient.body;
  const RigidState now = readState(body);
  const std::optional<double> part = partOfWay(rows, now, time_step);
  if (!part) return;
  const Twist moved_W = turned(rows.start.orientation, rows.start.twist);
  const Vector6 moved = turned(now.orientation.conjugate(), moved_W).vector();
  const StepModel step_model(ambient, time_step);
  const BodyModel& model = *step_model;
  BoundedTwist end{moved};
  if (rows.momentum) {
    const Vector3 position = rows.momentum->pivot + *part * time_step * moved_W.linear;
    end.twist = twistOf(model, *rows.momentum, now.orientation, position).vector();
  }
  if (rows.energy_bound)
    end = rows.momentum ? keepingMomentum(model, rows, moved, end.twist)
                        : withinEnergy(model, moved, end.twist, *rows.energy_bound);
  double energy_removed = end.energy_removed;
  if (ambient.surface()) {
    AmbientBody* const one = &ambient;
    passWithRows(&one, 1, rows.momentum ? Axes::kFree : Axes::kLocked, time_step, &end);
    energy_removed += end.energy_removed;
  }
  const Twist change_B = Twist::fromVector(end.twist - moved);
  const Twist change_W = withoutTraces(turned(now.orientation, change_B), time_step);
  if (!change_W.vector().allFinite()) {
    ++ambient.counters.rejected;
    complaints.say(Complaint::kNotFinite);
    return;
  }
  ambient.counters.energy_removed += energy_removed;
  body.setAngularVelocity(body.getAngularVelocity() + toBullet(change_W.angular));
  body.setLinearVelocity(body.getLinearVelocity() + toBullet(change_W.linear));
}

AMBIENT_END
