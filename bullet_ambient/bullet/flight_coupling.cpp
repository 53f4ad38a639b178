#include "bullet_ambient/bullet/flight_coupling.h"

#include <cmath>
#include <exception>

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

constexpr double kRestingTravel = 0.01;  // of the body's size, within kRestingTime
constexpr double kRestingTime = 2;       // [s], Bullet's gDeactivationTime by default

Twist worldTwist(const RigidState& state) {
  return {state.orientation * state.twist.angular, state.orientation * state.twist.linear};
}

}  // namespace

bool prepareStep(AmbientBody& ambient, Complaints& complaints) noexcept {
  SubstepOutcome& outcome = ambient.outcome;
  if (outcome.kind == Outcome::kFlown) complaints.say(Complaint::kNoAction);
  outcome.kind = Outcome::kStock;
  outcome.world_index = ambient.body->getWorldArrayIndex();
  outcome.rows = {};
  if (!ambient.isInFluid()) return false;
  if (ambient.body->isStaticOrKinematicObject()) return false;  // for now
  if (!isModelStale(ambient)) return true;
  try {
    rebuildModel(ambient);
    return true;
  } catch (const std::exception&) {
    complaints.say(Complaint::kNotPhysical);
    return false;
  }
}

bool stopIfNotFinite(AmbientBody& ambient, Complaints& complaints) noexcept {
  btRigidBody& body = *ambient.body;
  if (toVector3(body.getLinearVelocity()).allFinite() &&
      toVector3(body.getAngularVelocity()).allFinite()) {
    return false;
  }
  body.setLinearVelocity({0, 0, 0});
  body.setAngularVelocity({0, 0, 0});
  ambient.memory = {};
  ++ambient.counters.rejected;
  complaints.say(Complaint::kNotFinite);
  return true;
}

void boundEnergy(AmbientBody& ambient, const Twist& solved_W, const Twist& turning_W) noexcept {
  RigidState state = readState(*ambient.body);
  const Quaternion to_body = state.orientation.conjugate();
  const Vector3 flow_W = ambient.def.medium.velocity;
  state.twist.angular = to_body * (solved_W.angular - turning_W.angular);
  state.twist.linear = to_body * (solved_W.linear - turning_W.linear - flow_W);
  const double energy = inertiaNormSquared(ambient.model, state.twist.vector());
  if (energy >= 0) ambient.outcome.rows.energy_bound = energy;  // else it is not finite
}

void limitEnergy(AmbientBody& ambient) noexcept {
  const std::optional<double>& bound = ambient.outcome.rows.energy_bound;
  if (!bound) return;
  btRigidBody& body = *ambient.body;
  RigidState state = readState(body);
  const Vector3 flow_W = ambient.def.medium.velocity;
  state.twist.linear -= state.orientation.conjugate() * flow_W;
  const double energy = inertiaNormSquared(ambient.model, state.twist.vector());
  if (!(energy > *bound)) return;
  const double scale = std::sqrt(*bound / energy);
  const Twist now = worldTwist(state);
  body.setAngularVelocity(toBullet(Vector3(scale * now.angular)));
  body.setLinearVelocity(toBullet(Vector3(scale * now.linear + flow_W)));
}

void keepAwakeWhileMoving(const AmbientBody& ambient) noexcept {
  btRigidBody& body = *ambient.body;
  const double size = ambient.model.reference_length;
  const double travel =
      kRestingTime * (static_cast<double>(body.getLinearVelocity().length()) +
                      size * static_cast<double>(body.getAngularVelocity().length()));
  if (travel > kRestingTravel * size) body.setDeactivationTime(0);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
