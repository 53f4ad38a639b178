#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"
#include "bullet_ambient/bullet/rows/constraint_rows.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
namespace {

constexpr double kRounding = 16 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());

bool isBounded(const RowMotion& rows) { return std::isfinite(rows.energy_bound); }

// Returns the part of the way time_step * xi that the body has made: less than 1 if continuous
// collision detection has stopped it; none if its position is not on this way.
std::optional<double> partOfPath(const RowMotion& rows, const Vector3& position, double time_step) {
  const Vector3 displacement = time_step * (rows.flow_W + rows.velocity_W.linear);
  const Vector3 gone = position - rows.position;
  const double rounding = kRounding * (position.norm() + displacement.norm());
  double part = 1;
  if ((gone - displacement).norm() > rounding && displacement.squaredNorm() > 0)
    part = std::clamp(gone.dot(displacement) / displacement.squaredNorm(), 0.0, 1.0);
  if ((gone - part * displacement).norm() > rounding) return std::nullopt;
  return part;
}

// Returns the pose to which the velocity xi turns and carries the body; that of Bullet, `reached`,
// where it is another one by more than rounding.
FrameOffset poseAfter(const RowMotion& rows, const Quaternion& orientation, const Vector3& position,
                      double part, double time_step) {
  const Quaternion turned =
      rotationFromVector(time_step * rows.velocity_W.angular) * rows.orientation;
  const bool turns = (turned.conjugate() * orientation).vec().norm() <= kRounding;
  return {
      (turns ? turned : orientation).toRotationMatrix(),
      part == 1 ? rows.position + time_step * (rows.flow_W + rows.velocity_W.linear) : position};
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
  const double bound = rows.energy_bound;
  const Vector6 spin = spinAlone(model, to.head<3>()), straight = to - spin;
  const double energy = inertiaNormSquared(model, straight);
  if (energy > bound) {
    if (rows.is_anchored) return withinEnergy(model, from, to, bound);
    return {std::sqrt(bound / energy) * straight, (inertiaNormSquared(model, to) - bound) / 2};
  }
  BoundedTwist end = withinEnergy(model, spinAlone(model, from.head<3>()), spin, bound - energy);
  end.twist += straight;
  return end;
}

// Corrects an attitude as Bullet would, by `turn_W` of the rows' split impulses, and leaves Bullet
// nothing to turn. Returns the attitude that Bullet will move the body from.
Quaternion correctedAttitude(const Quaternion& start, const Vector3& turn_W,
                             btSolverBody& solver_body) {
  if (turn_W.isZero(0)) return start;
  const Quaternion corrected = turnedByBullet(start, turn_W);
  solver_body.m_worldTransform.setRotation(toBullet(corrected));
  solver_body.internalGetTurnVelocity().setZero();
  return corrected;
}

// Sets the momentum that the turn of a body keeps, if one is, and the bound of its energy, from the
// results of FlightKernel::conserve().
void setKept(const RowLanes& lanes, int lane, bool is_kept, RowMotion& rows) {
  const FlightLane* momentum_W = lanes.momentum_W;
  AMBIENT_ASSERT(!(lanes.turn_number[lane] < 0));
  double turn_number = lanes.turn_number[lane];
  if (is_kept) {
    rows.momentum_W = {vectorOf(momentum_W, lane), vectorOf(momentum_W + 3, lane)};
    turn_number = std::max(turn_number, lanes.moved_turn_number[lane]);
  }
  if (turn_number > kSlowTurn) rows.energy_bound = std::max(0.0, lanes.twice_energy[lane]);
}

// Turns a body that Bullet has moved to where it has come on its way.
void settleMoved(AmbientBody& ambient, double time_step) {
  btRigidBody& body = *ambient.body;
  const RowMotion& rows = ambient.outcome.rows();
  const auto part = partOfPath(rows, toVector3(body.getWorldTransform().getOrigin()), time_step);
  if (!part) return;
  const Vector3 turn_W = *part * time_step * rows.velocity_W.angular;
  settleAttitude(body, turnedByBullet(rows.orientation, turn_W));
}

// A body that does not fly, where Bullet has moved it, in the course of endRowMotions().
struct MovedBody {
  AmbientBody* ambient = nullptr;
  Quaternion orientation;  // B to W
  FrameOffset pose;        // B to W, before Bullet rounded it
  double part = 1;         // partOfPath()
  Vector6 moved;           // xi in B
  BoundedTwist end;        // of the step, in B
  std::optional<StepModel> model;

  const RowMotion& rows() const { return ambient->outcome.rows(); }
};

// Fills `moved_bodies` with the bodies whose velocity may have to change. Returns their number.
int findMovedBodies(AmbientBody* const* bodies, int count, double time_step,
                    MovedBody* moved_bodies) {
  AmbientBody* changing[kFlightsTogether] = {};
  Twist moved_W[kFlightsTogether];
  int found = 0;
  for (int i = 0; i < count; ++i) {
    const RowMotion& rows = bodies[i]->outcome.rows();
    if (!rows.momentum_W && !isBounded(rows) && !bodies[i]->surface()) continue;
    moved_W[found] = rows.velocity_W;
    changing[found++] = bodies[i];
  }
  if (found == 0) return 0;
  Quaternion orientations[kFlightsTogether];
  Twist moved_B[kFlightsTogether];
  readAttitudes(changing, moved_W, found, orientations, moved_B);
  int moved_count = 0;
  for (int i = 0; i < found; ++i) {
    AmbientBody& ambient = *changing[i];
    const Vector3 position = toVector3(ambient.body->getWorldTransform().getOrigin());
    const RowMotion& rows = ambient.outcome.rows();
    const auto part = partOfPath(rows, position, time_step);
    const bool is_turned_by_others =
        isTurnedFurther(rows.orientation, orientations[i],
                        time_step * rows.velocity_W.angular.norm() + kTurnRounding);
    if (!part || is_turned_by_others) continue;
    MovedBody& moved_body = moved_bodies[moved_count++];
    moved_body.ambient = &ambient;
    moved_body.orientation = orientations[i];
    moved_body.part = *part;
    if (ambient.surface())
      moved_body.pose =
          poseAfter(ambient.outcome.rows(), moved_body.orientation, position, *part, time_step);
    moved_body.moved = moved_B[i].vector();
    moved_body.end = {moved_body.moved};
    moved_body.model.emplace(ambient, time_step);
  }
  return moved_count;
}

// Computes the twists that keep the momenta, eq. (31), of the bodies that keep one.
void keepMomenta(MovedBody* const* moved_bodies, int count, double time_step) {
  const BodyModel* models[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i) models[i] = &**moved_bodies[i]->model;
  if (count == 0) return;
  RowLanes lanes;
  setModels(models, count, lanes);
  for (int i = 0; i < count; ++i) {
    const RowMotion& rows = moved_bodies[i]->rows();
    setLane(lanes.orientation, i, moved_bodies[i]->orientation);
    setLane(lanes.momentum_W, i, *rows.momentum_W);
    setLane(lanes.displacement_W, i,
            Vector3(moved_bodies[i]->part * time_step * rows.velocity_W.linear));
  }
  kFlightKernels.fastest()->transport(lanes);
  for (int i = 0; i < count; ++i) moved_bodies[i]->end.twist = twistOf(lanes.twist_B, i).vector();
}

// Bounds the energy of a fast turn, eq. (31a).
void boundTurnEnergy(MovedBody& moved_body) {
  const RowMotion& rows = moved_body.rows();
  if (!isBounded(rows)) return;
  const BodyModel& model = **moved_body.model;
  const Vector6 &from = moved_body.moved, to = moved_body.end.twist;
  moved_body.end = rows.momentum_W ? keepingMomentum(model, rows, from, to)
                                   : withinEnergy(model, from, to, rows.energy_bound);
}

// Passes bodies that are at a surface through it, side by side.
void changeAtSurface(MovedBody* const* moved_bodies, int count, double time_step) {
  BodyMovedByRows moved[kFlightsTogether];
  for (int i = 0; i < count; ++i) {
    const MovedBody& body = *moved_bodies[i];
    moved[i] = {body.ambient, body.pose, body.end, axisFactors(*body.ambient->body),
                body.rows().momentum_W.has_value()};
  }
  if (count == 0) return;
  applyAddedMassChanges(moved, count, time_step);
  for (int i = 0; i < count; ++i) {
    moved_bodies[i]->end.twist = moved[i].twist.twist;
    moved_bodies[i]->end.energy_removed += moved[i].twist.energy_removed;
  }
}

void setVelocity(const MovedBody& moved_body, double time_step, Warnings& warnings) {
  AmbientBody& ambient = *moved_body.ambient;
  const BoundedTwist& end = moved_body.end;
  Twist change_B = Twist::fromVector(end.twist - moved_body.moved);
  if (ambient.surface()) change_B.angular = ambient.surface()->withoutStill(change_B.angular);
  Twist change_W = withoutTraces(turned(moved_body.orientation, change_B), time_step);
  const bool may_be_locked = !moved_body.rows().momentum_W;
  if (may_be_locked) change_W = onFreeAxes(change_W, axisFactors(*ambient.body));
  if (!change_W.vector().allFinite()) {
    ++ambient.counters.rejected;
    warnings.warnOnce(Warning::kNotFinite);
    return;
  }
  ambient.counters.energy_removed += end.energy_removed;
  addVelocity(*ambient.body, change_W);
}

}  // namespace

void beginRowMotions(RowBatch& batch, RowBodies& row_bodies,
                     btAlignedObjectArray<btSolverBody>& solver_bodies, double turn_share,
                     double time_step) noexcept {
  AMBIENT_ASSERT(batch.count > 0 && batch.count <= kFlightsTogether && time_step > 0);
  RowLanes& lanes = batch.lanes;
  for (int i = 0; i < batch.count; ++i) {
    if (lanes.active[i] == 0) continue;
    btSolverBody& solver_body = solver_bodies[batch.solver_bodies[i]];
    RowMotion& rows = batch.bodies[i]->outcome.rows();
    const Medium& medium = batch.bodies[i]->medium;
    rows.flow_W = medium.velocity + time_step * medium.acceleration;
    rows.velocity_W = solvedVelocity(solver_body);
    rows.velocity_W.linear -= rows.flow_W;
    setLane(lanes.velocity_W, i, rows.velocity_W);
    setLane(lanes.by_rows_W, i, changeByRows(solver_body));
  }
  kFlightKernels.fastest()->conserve(lanes);
  for (int i = 0; i < batch.count; ++i) {
    if (lanes.active[i] == 0) continue;
    btSolverBody& solver_body = solver_bodies[batch.solver_bodies[i]];
    const RowBody& row_body = *row_bodies.find(batch.solver_bodies[i]);
    RowMotion& rows = batch.bodies[i]->outcome.rows();
    rows.is_anchored = row_body.is_anchored;
    rows.load_W = batch.loads_W[i];
    rows.orientation = correctedAttitude(
        orientationOf(lanes.orientation, i),
        turn_share * time_step * toVector3(solver_body.internalGetTurnVelocity()), solver_body);
    rows.position =
        batch.positions[i] + time_step * toVector3(solver_body.internalGetPushVelocity());
    setKept(lanes, i, !row_body.is_locked && !batch.settled_inertia[i], rows);
  }
}

void endRowMotions(AmbientBody* const* bodies, int count, double time_step,
                   Warnings& warnings) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  MovedBody moved_bodies[kFlightsTogether];
  MovedBody *keeping[kFlightsTogether] = {}, *at_surface[kFlightsTogether] = {};
  int keeping_count = 0, at_surface_count = 0;
  for (int i = 0; i < count; ++i) settleMoved(*bodies[i], time_step);
  const int moved_count = findMovedBodies(bodies, count, time_step, moved_bodies);
  for (int i = 0; i < moved_count; ++i) {
    MovedBody& body = moved_bodies[i];
    if (body.rows().momentum_W) keeping[keeping_count++] = &body;
    if (body.ambient->surface()) at_surface[at_surface_count++] = &body;
  }
  keepMomenta(keeping, keeping_count, time_step);
  for (int i = 0; i < moved_count; ++i) boundTurnEnergy(moved_bodies[i]);
  changeAtSurface(at_surface, at_surface_count, time_step);
  for (int i = 0; i < moved_count; ++i) setVelocity(moved_bodies[i], time_step, warnings);
}

AMBIENT_END
