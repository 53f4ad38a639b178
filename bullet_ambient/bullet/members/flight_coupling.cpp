#include "bullet_ambient/bullet/members/flight_coupling.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/flow_along.h"
#include "bullet_ambient/immersed/region_following.h"
#include "bullet_ambient/immersed/vessel_step.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/surface/surface_flight.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN

void readAttitudes(AmbientBody* const* bodies, const Twist* twists_W, int count,
                   Quaternion* orientations, Twist* twists_B) noexcept {
  const btMatrix3x3* rotations[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i) rotations[i] = &bodies[i]->body->getWorldTransform().getBasis();
  computeAttitudes(rotations, twists_W, count, orientations, twists_B);
}

void computeAttitudes(const btMatrix3x3* const* rotations, const Twist* twists_W, int count,
                      Quaternion* orientations, Twist* twists_B) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  StartLanes lanes{};
  for (int i = 0; i < count; ++i) {
    for (int row = 0; row < 3; ++row)
      setLane(lanes.rotation + 3 * row, i, toVector3((*rotations[i])[row]));
    setLane(lanes.twist_W, i, twists_W[i]);
  }
  kFlightKernels.fastest()->readStarts(lanes);
  for (int i = 0; i < count; ++i) {
    orientations[i] = orientationOf(lanes.orientation, i);
    twists_B[i] = twistOf(lanes.twist_B, i);
  }
}

void readStartStates(AmbientBody* const* bodies, int count, StartStates& starts) noexcept {
  for (int i = 0; i < count; ++i) starts.twists_W[i] = velocityOf(*bodies[i]->body);
  Quaternion orientations[kFlightsTogether];
  Twist twists_B[kFlightsTogether];
  readAttitudes(bodies, starts.twists_W, count, orientations, twists_B);
  for (int i = 0; i < count; ++i) {
    const Vector3 position = toVector3(bodies[i]->body->getWorldTransform().getOrigin());
    starts.states[i] = {orientations[i], position, twists_B[i]};
    starts.surroundings[i] = readSurroundings(*bodies[i]);
  }
}

bool prepareStep(AmbientBody& ambient, AmbientBodies& bodies, double time_step) noexcept {
  SubstepOutcome& outcome = ambient.outcome;
  if (outcome.kind == Outcome::kFlown) bodies.warnings.warnOnce(Warning::kNoAction);
  bodies.noteSolved(ambient);
  outcome.world_index = ambient.body->getWorldArrayIndex();
  const btRigidBody& body = *ambient.body;
  if (body.isStaticOrKinematicObject()) return false;  // for now
  const Twist twist_W = velocityOf(body);
  const InverseMass mass = inverseMassOf(body);
  if (!mayBeInRegion(ambient, bodies.regions))
    return prepareFluid(ambient, nullptr, twist_W, mass, bodies, time_step);
  const MotionView now = motionOf(body);
  return prepareFluid(ambient, &now, twist_W, mass, bodies, time_step);
}

bool prepareFluid(AmbientBody& ambient, const MotionView* now, const Twist& twist_W,
                  const InverseMass& mass, AmbientBodies& bodies, double time_step) noexcept {
  AMBIENT_ASSERT(time_step >= 0);
  const bool may_be_in_region = mayBeInRegion(ambient, bodies.regions);
  AMBIENT_ASSERT(now || !may_be_in_region);
  if (may_be_in_region) {
    followRegions(ambient, *now, bodies.regions, time_step, bodies.warnings);
  } else {
    stayInOwnMedium(ambient, bodies.regions, time_step);
  }
  if (!ambient.isInFluid()) return false;
  try {
    if (isModelStale(ambient, mass)) rebuildModels(ambient, mass);
  } catch (const std::exception&) {
    bodies.warnings.warnOnce(Warning::kNotPhysical);
    return false;
  }
  followWake(ambient, twist_W, time_step);
  if (ambient.vessel && ambient.surface()) {
    findRimWaves(ambient, *now, bodies.regions);
    if (exchangeWater(ambient, *now, time_step)) warnOfSunkVessel(ambient, bodies.warnings);
  }
  if (may_be_in_region) findPushes(ambient, *now, bodies.regions, time_step);
  return true;
}

void disable(AmbientBody& ambient, AmbientBodies& bodies) noexcept {
  bodies.noteSolved(ambient);
  SubstepOutcome& outcome = ambient.outcome;
  outcome.kind = Outcome::kDisabled;
  outcome.world_index = ambient.body->getWorldArrayIndex();
  outcome.activation_state = ambient.body->getActivationState();
  ambient.body->forceActivationState(DISABLE_SIMULATION);
}

void restoreActivation(AmbientBody& ambient) noexcept {
  ambient.body->forceActivationState(ambient.outcome.activation_state);
}

void stopIfNotFinite(AmbientBody& ambient, Warnings& warnings) noexcept {
  btRigidBody& body = *ambient.body;
  // Zero times a number is zero if it is finite.
  const btVector3 nothing = 0 * body.getLinearVelocity() + 0 * body.getAngularVelocity();
  if (nothing.x() + nothing.y() + nothing.z() == 0) return;
  body.setLinearVelocity({0, 0, 0});
  body.setAngularVelocity({0, 0, 0});
  forgetFlight(ambient);
  forgetWake(ambient);
  ++ambient.counters.rejected;
  warnings.warnOnce(Warning::kNotFinite);
}

void keepAwake(AmbientBody& ambient, Outcome kind) noexcept {
  btRigidBody& body = *ambient.body;
  const bool has_rows = kind == Outcome::kRows;
  const bool moves = (!has_rows || ambient.surface()) &&
                     drifts(static_cast<double>(body.getLinearVelocity().length()),
                            static_cast<double>(body.getAngularVelocity().length()),
                            ambient.model().reference_length);
  const auto mayTurnOver = [&] {
    return ambient.surface() && !has_rows && !mayRestAtSurface(ambient, motionOf(body));
  };
  if (moves || !ambient.may_rest || mayTurnOver()) body.setDeactivationTime(0);
}

namespace {

// Relative change of the velocity by others, in the norm of K, beyond which the load kept from the
// last flight is not used.
constexpr double kSameVelocity = 1e-3;
// FlightTask::precision. Its error grows with the number of steps, rounding with the root of it.
constexpr double kPrecision = std::max(1e-16, 1e-4 * kBulletRounding);

// True if a velocity in Bullet is `b` up to a few of its roundings.
bool isWithinRounding(const Vector3& a, const Vector3& b) {
  constexpr double kRounding = std::max(1e-12, 8 * kBulletRounding);
  return (a - b).squaredNorm() <= kRounding * kRounding * b.squaredNorm();
}

// True if the velocity `now` (world axes) differs from `left`, the one that the last flight left.
bool wasMovedByOthers(const AmbientBody& ambient, const Twist& left, const RigidState& start,
                      const Twist& now) {
  if (isWithinRounding(now.angular, left.angular) && isWithinRounding(now.linear, left.linear))
    return false;
  const Quaternion to_body = start.orientation.conjugate();
  const Twist change{to_body * (now.angular - left.angular), to_body * (now.linear - left.linear)};
  return inertiaNormSquared(ambient.metric(), change.vector()) >
         kSameVelocity * kSameVelocity * inertiaNormSquared(ambient.metric(), start.twist.vector());
}

SurfaceFlight surfaceFlight(AmbientBody& ambient, Flight& flight) {
  FloatingState& floating = *ambient.floating;
  const FlightTask& task = flight.task;
  RigidState& start = flight.body.state;
  AmbientBody* const body = &ambient;
  updateFlotations(&body, &start, 1, kBulletRounding);
  const SurfaceModel* model = ambient.surface();
  AMBIENT_ASSERT(model);
  if (ambient.vessel)
    start.twist = Twist::fromVector(start.twist.vector() + ambient.vessel->change_B);
  return {*model,         floating.plane_W,  task.surroundings,         floating.velocity_above,
          task.settings,  task.duration,     waterAtFlotation(ambient), flight.body,
          floating.waves, floating.flotation};
}

void flyNearSurface(AmbientBody* const* bodies, Flight* const* flights, int count) {
  std::optional<SurfaceFlight> near[kFlightsTogether];
  SurfaceFlight* all[kFlightsTogether];
  for (int i = 0; i < count; ++i) all[i] = &near[i].emplace(surfaceFlight(*bodies[i], *flights[i]));
  flyAtSurface(all, count);
}

// Flies the bodies at a water surface side by side, and then all others side by side.
void flyAll(AmbientBody* const* bodies, Flight* const* flights, int count) {
  AmbientBody* at_surface[kFlightsTogether];
  Flight *near[kFlightsTogether], *free[kFlightsTogether];
  int near_count = 0, free_count = 0;
  for (int i = 0; i < count; ++i) {
    if (bodies[i]->surface()) {
      at_surface[near_count] = bodies[i];
      near[near_count++] = flights[i];
    } else {
      free[free_count++] = flights[i];
    }
  }
  if (near_count > 0) flyNearSurface(at_surface, near, near_count);
  if (free_count > 0) flyTogether(free, free_count);
}

// Writes the twists at the end of the flights, and the mean twists u_eff of docs/theory.md eq.
// (29); world axes.
void computeEnds(const StartStates& starts, const Flight* const* flights, int count,
                 double time_step, Twist* ends_W, Twist* means_W) {
  EndLanes lanes{};
  lanes.duration = time_step;
  lanes.least = leastVelocity(time_step);
  for (int i = 0; i < count; ++i) {
    const RigidState &start = starts.states[i], &end = flights[i]->body.state;
    setLane(lanes.start_orientation, i, start.orientation);
    setLane(lanes.start_position, i, start.position);
    setLane(lanes.orientation, i, end.orientation);
    setLane(lanes.position, i, end.position);
    setLane(lanes.twist_B, i, end.twist);
  }
  kFlightKernels.fastest()->findEnds(lanes);
  for (int i = 0; i < count; ++i) {
    ends_W[i] = twistOf(lanes.twist_W, i);
    means_W[i] = twistOf(lanes.mean_W, i);
  }
}

// False if a number is not finite in Bullet's precision, or its square not in double. An
// orientation that is not finite gives such a twist.
bool fitsBullet(const Vector3& position, const Twist& twist_W) {
  constexpr auto kLargest = static_cast<double>(std::numeric_limits<btScalar>::max());
  return position.squaredNorm() / kLargest < kLargest &&
         twist_W.linear.squaredNorm() / kLargest < kLargest &&
         twist_W.angular.squaredNorm() / kLargest < kLargest;
}

void countFlight(const FlightCount& count, AmbientBody& ambient) {
  ambient.counters.substeps += count.substeps;
  countLoads(ambient, count.load_evaluations);
  ambient.counters.guarded += count.guarded;
  ambient.counters.coarse += count.coarse;
  ambient.counters.halted += count.halted;
}

// Stores the end of a flight in the outcome of the body. An end that is not finite in Bullet's
// precision is dropped and counted: the body is adrift.
void keepFlight(const FlightResult& flight, const Twist& end_W, const Twist& mean_W,
                AmbientBody& ambient) {
  countFlight(flight.count, ambient);
  SubstepOutcome& outcome = ambient.outcome;
  // No warning if the user limits max_substeps.
  outcome.is_too_long =
      ambient.step_errors.add(flight.count.error) && ambient.def->flight.max_substeps == 0;
  if (outcome.is_too_long) ambient.counters.too_long = 1;
  if (!fitsBullet(flight.state.position, end_W)) {
    outcome.kind = Outcome::kNoFlight;
    outcome.motion = RowMotion{};
    ++ambient.counters.rejected;
    forgetSurface(ambient);
    return;
  }
  outcome.kind = Outcome::kFlown;
  ambient.counters.energy_removed += flight.count.energy_removed;
  outcome.motion =
      LastFlight{end_W, mean_W, flight.memory, flight.state.orientation, flight.state.position};
}

// True if Bullet does not reach the end orientation: it limits the rotation per step. Also true
// from half a turn on: u_eff contains the rotation modulo a turn only, and its rounding would
// change the angular momentum.
bool turnsTooFarForBullet(const LastFlight& flight, double time_step) {
  return flight.effective_W.angular.norm() * time_step > kMostTurn * (1 - 1e-6) ||
         flight.left_W.angular.norm() * time_step > kPi;
}

// Returns the part of its way that the body lacks: 0 at the end of its flight to rounding, more if
// continuous collision detection has stopped it; none if others have moved it.
std::optional<double> missingPart(const AmbientBody& ambient, const LastFlight& flight,
                                  double time_step) {
  const Vector3 missing =
      flight.position - toVector3(ambient.body->getWorldTransform().getOrigin());
  const Vector3 displacement = time_step * flight.effective_W.linear;
  const double size =
      flight.position.norm() + ambient.model().reference_length + displacement.norm();
  const double rounding = 16 * kBulletRounding * size;
  if (missing.norm() <= rounding) return 0;
  const double part = std::clamp(missing.dot(displacement) / displacement.squaredNorm(), 0.0, 1.0);
  if (!((missing - part * displacement).norm() <= rounding)) return std::nullopt;
  return part;
}

// Turns a body that Bullet has moved to where its flight was then.
void settleFlight(AmbientBody& ambient, const LastFlight& flight, double time_step) {
  btRigidBody& body = *ambient.body;
  const auto missing = missingPart(ambient, flight, time_step);
  if (!missing) return;
  if (*missing > 0) {
    const Vector3 turn_W = -*missing * time_step * flight.effective_W.angular;
    settleAttitude(body, rotationFromVector(turn_W) * flight.orientation);
  } else if (turnsTooFarForBullet(flight, time_step)) {
    btTransform end = body.getWorldTransform();
    end.setRotation(toBullet(flight.orientation));
    body.setCenterOfMassTransform(end);
  } else {
    settleAttitude(body, flight.orientation);
  }
}

}  // namespace

void beginFlights(AmbientBody* const* bodies, const StartStates& starts, int count,
                  double time_step, Twist* changes_W) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  AMBIENT_ASSERT(time_step > 0);
  std::optional<Flight> flights[kFlightsTogether];
  Flight* all[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i) {
    AmbientBody& ambient = *bodies[i];
    const RigidState& start = starts.states[i];
    LastFlight& last = ambient.outcome.flight();
    if (wasMovedByOthers(ambient, last.left_W, start, starts.twists_W[i]))
      last.memory.has_load = false;
    const FlightTask task{ambient.model(), starts.surroundings[i], ambient.def->flight, time_step,
                          kPrecision};
    all[i] = &flights[i].emplace(task, start, last.memory);
  }
  flyAll(bodies, all, count);
  Twist ends_W[kFlightsTogether], means_W[kFlightsTogether];
  computeEnds(starts, all, count, time_step, ends_W, means_W);
  for (int i = 0; i < count; ++i) {
    AmbientBody& ambient = *bodies[i];
    const FlightResult& flight = all[i]->body;
    const Twist &mean_W = means_W[i], &before_W = starts.twists_W[i];
    keepFlight(flight, ends_W[i], mean_W, ambient);
    changes_W[i] = {};
    if (ambient.outcome.kind == Outcome::kFlown)
      changes_W[i] = {mean_W.angular - before_W.angular, mean_W.linear - before_W.linear};
  }
}

void flyBodies(const FreeBody* bodies, int count, double time_step) noexcept {
  AmbientBody* flying[kFlightsTogether] = {};
  Twist changes_W[kFlightsTogether];
  for (int i = 0; i < count; ++i) flying[i] = bodies[i].ambient;
  StartStates starts;
  readStartStates(flying, count, starts);
  beginFlights(flying, starts, count, time_step, changes_W);
  for (int i = 0; i < count; ++i) {
    if (bodies[i].solver_body) {
      setExternalImpulse(*bodies[i].solver_body, changes_W[i]);
    } else {
      addVelocity(*bodies[i].ambient->body, changes_W[i]);
    }
  }
}

void endFlight(AmbientBody& ambient, double time_step) noexcept {
  btRigidBody& body = *ambient.body;
  const LastFlight& flight = std::as_const(ambient.outcome).flight();
  settleFlight(ambient, flight, time_step);
  const Twist &end = flight.left_W, &effective = flight.effective_W;
  addVelocity(body, {end.angular - effective.angular, end.linear - effective.linear});
}

AMBIENT_END
