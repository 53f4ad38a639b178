#include "bullet_ambient/bullet/members/flight_coupling.h"

#include <exception>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/immersed/region_following.h"
#include "bullet_ambient/immersed/station_samples.h"
#include "bullet_ambient/immersed/surface_encounter.h"

AMBIENT_BEGIN
namespace {

constexpr double kRestingTravel = 0.01;  // of the body's size, within kRestingTime
constexpr double kRestingTime = 2;       // [s], Bullet's gDeactivationTime by default

}  // namespace

bool prepareStep(AmbientBody& ambient, AmbientBodies& bodies, double time_step) noexcept {
  SubstepOutcome& outcome = ambient.outcome;
  if (outcome.kind == Outcome::kFlown) bodies.complaints.say(Complaint::kNoAction);
  bodies.meet(ambient);
  outcome.world_index = ambient.body->getWorldArrayIndex();
  return prepareFluid(ambient, bodies, time_step);
}

bool prepareFluid(AmbientBody& ambient, AmbientBodies& bodies, double time_step) noexcept {
  AMBIENT_ASSERT(ambient.body && time_step >= 0);
  if (ambient.body->isStaticOrKinematicObject()) return false;  // for now
  followRegions(ambient, bodies.regions, time_step, bodies.complaints);
  if (!ambient.isInFluid()) return false;
  try {
    if (isModelStale(ambient)) rebuildModels(ambient);
  } catch (const std::exception&) {
    bodies.complaints.say(Complaint::kNotPhysical);
    return false;
  }
  followWake(ambient, time_step);
  findPushes(ambient, time_step);
  return true;
}

void hold(AmbientBody& ambient, AmbientBodies& bodies) noexcept {
  bodies.meet(ambient);
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
  const bool may_turn_over = ambient.surface() && !has_rows && !mayRestAtSurface(ambient);
  if (moves || may_turn_over) body.setDeactivationTime(0);
}

void keepAwakeInUnsteadyFluid(const AmbientBody& ambient) noexcept {
  if (!ambient.may_rest) ambient.body->setDeactivationTime(0);
}

AMBIENT_END
