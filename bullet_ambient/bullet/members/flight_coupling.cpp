#include "bullet_ambient/bullet/members/flight_coupling.h"

#include <exception>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/region_following.h"
#include "bullet_ambient/immersed/station_samples.h"
#include "bullet_ambient/immersed/vessel_step.h"
#include "bullet_ambient/motion/flight/flight_group.h"

AMBIENT_BEGIN

void readAttitudes(AmbientBody* const* bodies, const Twist* twists_W, int count,
                   Attitudes& attitudes) noexcept {
  const btMatrix3x3* rotations[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i) rotations[i] = &bodies[i]->body->getWorldTransform().getBasis();
  computeAttitudes(rotations, twists_W, count, attitudes);
}

void computeAttitudes(const btMatrix3x3* const* rotations, const Twist* twists_W, int count,
                      Attitudes& attitudes) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  DepartureLanes lanes{};
  for (int i = 0; i < count; ++i) {
    for (int row = 0; row < 3; ++row)
      setLane(lanes.rotation + 3 * row, i, toVector3((*rotations[i])[row]));
    setLane(lanes.twist_W, i, twists_W[i]);
  }
  kFlightKernels.fastest()->depart(lanes);
  for (int i = 0; i < count; ++i) {
    attitudes.orientations[i] = orientationOf(lanes.orientation, i);
    attitudes.twists_B[i] = twistOf(lanes.twist_B, i);
  }
}

void readDepartures(AmbientBody* const* bodies, int count, Departures& departures) noexcept {
  for (int i = 0; i < count; ++i) departures.twists_W[i] = velocityOf(*bodies[i]->body);
  Attitudes attitudes;
  readAttitudes(bodies, departures.twists_W, count, attitudes);
  for (int i = 0; i < count; ++i) {
    const Vector3 position = toVector3(bodies[i]->body->getWorldTransform().getOrigin());
    departures.states[i] = {attitudes.orientations[i], position, attitudes.twists_B[i]};
    departures.surroundings[i] = readSurroundings(*bodies[i]);
  }
}

namespace {

constexpr double kRestingTravel = 0.01;  // of the body's size, within kRestingTime
constexpr double kRestingTime = 2;       // [s], Bullet's gDeactivationTime by default

}  // namespace

bool prepareStep(AmbientBody& ambient, AmbientBodies& bodies, double time_step) noexcept {
  SubstepOutcome& outcome = ambient.outcome;
  if (outcome.kind == Outcome::kFlown) bodies.complaints.say(Complaint::kNoAction);
  bodies.noteSolved(ambient);
  outcome.world_index = ambient.body->getWorldArrayIndex();
  const btRigidBody& body = *ambient.body;
  if (body.isStaticOrKinematicObject()) return false;  // for now
  const Twist twist_W = velocityOf(body);
  const InverseMass mass = inverseMassOf(body);
  if (!mayBeInRegion(ambient, bodies.regions))
    return prepareFluid(ambient, {nullptr, twist_W, mass}, bodies, time_step);
  const MotionView now = motionOf(body);
  return prepareFluid(ambient, {&now, twist_W, mass}, bodies, time_step);
}

bool prepareFluid(AmbientBody& ambient, const StepStart& start, AmbientBodies& bodies,
                  double time_step) noexcept {
  AMBIENT_ASSERT(time_step >= 0);
  const bool may_be_in_region = mayBeInRegion(ambient, bodies.regions);
  AMBIENT_ASSERT(start.now || !may_be_in_region);
  if (may_be_in_region) {
    followRegions(ambient, *start.now, bodies.regions, time_step, bodies.complaints);
  } else {
    stayInOwnMedium(ambient, bodies.regions, time_step);
  }
  if (!ambient.isInFluid()) return false;
  try {
    if (isModelStale(ambient, start.mass)) rebuildModels(ambient, start.mass);
  } catch (const std::exception&) {
    bodies.complaints.say(Complaint::kNotPhysical);
    return false;
  }
  followWake(ambient, start.twist_W, time_step);
  if (ambient.vessel && ambient.surface()) {
    findRimWaves(ambient, *start.now, bodies.regions);
    exchangeWater(ambient, *start.now, time_step);
    saySunk(ambient, bodies.complaints);
  }
  if (may_be_in_region) findPushes(ambient, *start.now, time_step);
  return true;
}

void hold(AmbientBody& ambient, AmbientBodies& bodies) noexcept {
  bodies.noteSolved(ambient);
  SubstepOutcome& outcome = ambient.outcome;
  outcome.kind = Outcome::kHeld;
  outcome.world_index = ambient.body->getWorldArrayIndex();
  outcome.activation_state = ambient.body->getActivationState();
  ambient.body->forceActivationState(DISABLE_SIMULATION);
}

void release(AmbientBody& ambient) noexcept {
  ambient.body->forceActivationState(ambient.outcome.activation_state);
}

void stopIfNotFinite(AmbientBody& ambient, Complaints& complaints) noexcept {
  btRigidBody& body = *ambient.body;
  // Zero times a number is zero if it is finite.
  const btVector3 nothing = 0 * body.getLinearVelocity() + 0 * body.getAngularVelocity();
  if (nothing.x() + nothing.y() + nothing.z() == 0) return;
  body.setLinearVelocity({0, 0, 0});
  body.setAngularVelocity({0, 0, 0});
  forgetFlight(ambient);
  forgetWake(ambient);
  ++ambient.counters.rejected;
  complaints.say(Complaint::kNotFinite);
}

void keepAwakeWhileMoving(AmbientBody& ambient, Outcome kind) noexcept {
  const bool has_rows = kind == Outcome::kRows;
  if (has_rows && !ambient.surface()) return;
  btRigidBody& body = *ambient.body;
  const double size = ambient.model().reference_length;
  const double travel =
      kRestingTime * (static_cast<double>(body.getLinearVelocity().length()) +
                      size * static_cast<double>(body.getAngularVelocity().length()));
  const bool moves = travel > kRestingTravel * size;
  const bool may_turn_over =
      ambient.surface() && !has_rows && !mayRestAtSurface(ambient, motionOf(body));
  if (moves || may_turn_over) body.setDeactivationTime(0);
}

void keepAwakeInUnsteadyFluid(const AmbientBody& ambient) noexcept {
  if (!ambient.may_rest) ambient.body->setDeactivationTime(0);
}

AMBIENT_END
