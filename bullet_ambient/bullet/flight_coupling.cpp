#include "bullet_ambient/bullet/flight_coupling.h"

#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include "bullet_ambient/motion/rotation.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// A velocity that others changed by more than this part since the last flight makes its history
// worthless.
constexpr double kSameVelocity = 1e-3;
constexpr double kBulletMaxTurn =
    3.14159265358979323846 / 4;          // [rad] per step in integrateTransform
constexpr double kRestingTravel = 0.01;  // of the body's size, within kRestingTime
constexpr double kRestingTime = 2;       // [s], Bullet's gDeactivationTime by default

Twist worldTwist(const RigidState& state) {
  return {state.orientation * state.twist.angular, state.orientation * state.twist.linear};
}

Twist bulletTwist(const btRigidBody& body) {
  return {toVector3(body.getAngularVelocity()), toVector3(body.getLinearVelocity())};
}

bool isWithinRounding(const Vector3& a, const Vector3& b) {
  constexpr double kRounding = 1e-12;
  return (a - b).squaredNorm() <= kRounding * kRounding * b.squaredNorm();
}

bool wasMovedByOthers(const AmbientBody& ambient, const RigidState& start, const Twist& now) {
  if (isWithinRounding(now.angular, ambient.left_W.angular) &&
      isWithinRounding(now.linear, ambient.left_W.linear)) {
    return false;
  }
  const Quaternion to_body = start.orientation.conjugate();
  Vector6 change;
  change << to_body * (now.angular - ambient.left_W.angular),
      to_body * (now.linear - ambient.left_W.linear);
  return inertiaNormSquared(ambient.model, change) >
         kSameVelocity * kSameVelocity * inertiaNormSquared(ambient.model, start.twist.vector());
}

// Within rounding of where the flight ends, or did a continuous collision stop the body on its way?
bool reachedEnd(const AmbientBody& ambient) {
  const Vector3 position = toVector3(ambient.body->getWorldTransform().getOrigin());
  const double rounding = 16 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());
  return (position - ambient.end.position).norm() <= rounding * ambient.length_scale;
}

bool fitsBullet(const RigidState& state, const Twist& twist_W) {
  constexpr auto kLargest = static_cast<double>(std::numeric_limits<btScalar>::max());
  return state.isFinite() && state.position.norm() < kLargest && twist_W.linear.norm() < kLargest &&
         twist_W.angular.norm() < kLargest;
}

// Where a flight begins.
struct Departure {
  RigidState state;
  Twist twist_W;  // as Bullet has it
  Surroundings surroundings;
  bool was_moved;
};

Departure departureOf(const AmbientBody& ambient) {
  Departure departure{readState(*ambient.body), bulletTwist(*ambient.body),
                      readSurroundings(ambient), false};
  departure.was_moved = wasMovedByOthers(ambient, departure.state, departure.twist_W);
  return departure;
}

void count(AmbientBody& ambient, const FlightCount& count) {
  ambient.counters.substeps += count.substeps;
  countLoads(ambient, count.load_evaluations);
  ambient.counters.guarded += count.guarded;
  ambient.counters.coarse += count.coarse;
  // Who sets a bound of substeps has chosen what is too long.
  ambient.was_coarse = count.coarse && ambient.def.flight.max_substeps == 0;
}

// Keeps the end of a flight. Returns the velocity change of eq. (29).
Twist arrive(AmbientBody& ambient, const Departure& departure, const FlightResult& flight,
             double time_step) {
  count(ambient, flight.count);
  const RigidState& start = departure.state;
  const Twist& before = departure.twist_W;
  ambient.end_W = worldTwist(flight.state);
  if (!fitsBullet(flight.state, ambient.end_W)) {
    ++ambient.counters.rejected;
    ambient.memory = {};
    ambient.has_flown = false;
    return {};
  }
  ambient.memory = flight.memory;
  ambient.end = flight.state;
  ambient.has_flown = true;
  const Quaternion turn = (flight.state.orientation * start.orientation.conjugate()).normalized();
  ambient.effective_W = {rotationVector(turn) / time_step,
                         (flight.state.position - start.position) / time_step};
  ambient.length_scale = flight.state.position.norm() + ambient.model.reference_length +
                         time_step * before.linear.norm();
  return {ambient.effective_W.angular - before.angular, ambient.effective_W.linear - before.linear};
}

}  // namespace

bool prepareStep(AmbientRegistry& registry, AmbientBody& ambient) noexcept {
  ambient.was_solved = true;
  ambient.energy_bound = -1;
  ambient.world_index = ambient.body->getWorldArrayIndex();
  if (ambient.has_flown) {
    registry.complain(AmbientRegistry::Complaint::kNoAction);
    ambient.has_flown = false;
  }
  if (!ambient.isInFluid()) return false;
  if (ambient.body->isStaticOrKinematicObject()) return false;  // for now
  if (!isModelStale(ambient)) return true;
  try {
    rebuildModel(ambient);
    return true;
  } catch (const std::exception&) {
    registry.complain(AmbientRegistry::Complaint::kNotPhysical);
    return false;
  }
}

bool stopIfNotFinite(AmbientRegistry& registry, AmbientBody& ambient) noexcept {
  btRigidBody& body = *ambient.body;
  if (toVector3(body.getLinearVelocity()).allFinite() &&
      toVector3(body.getAngularVelocity()).allFinite()) {
    return false;
  }
  body.setLinearVelocity({0, 0, 0});
  body.setAngularVelocity({0, 0, 0});
  ambient.memory = {};
  ++ambient.counters.rejected;
  registry.complain(AmbientRegistry::Complaint::kNotFinite);
  return true;
}

void beginFlights(AmbientBody* const* bodies, int count, double time_step,
                  Twist* changes_W) noexcept {
  Departure departures[kFlightsTogether];
  std::optional<Flight> flights[kFlightsTogether];
  Flight* all[kFlightsTogether] = {};
  for (int i = 0; i < count; ++i) {
    AmbientBody& ambient = *bodies[i];
    Departure& departure = departures[i];
    departure = departureOf(ambient);
    if (departure.was_moved) ambient.memory.has_load = false;
    const FlightTask task{ambient.model, departure.surroundings, ambient.def.flight, time_step};
    all[i] = &flights[i].emplace(Flight{task, {departure.state, ambient.memory, {}}});
  }
  flyTogether(all, count);
  for (int i = 0; i < count; ++i)
    changes_W[i] = arrive(*bodies[i], departures[i], all[i]->body, time_step);
}

void endFlight(AmbientBody& ambient, double time_step) noexcept {
  btRigidBody& body = *ambient.body;
  if (ambient.effective_W.angular.norm() * time_step > kBulletMaxTurn * (1 - 1e-6) &&
      reachedEnd(ambient)) {
    btTransform end = body.getWorldTransform();
    end.setRotation(toBullet(ambient.end.orientation));
    body.setCenterOfMassTransform(end);
  }
  const Twist& end = ambient.end_W;
  // Added, not set: impulses that other actions have applied meanwhile survive.
  body.setAngularVelocity(body.getAngularVelocity() +
                          toBullet(Vector3(end.angular - ambient.effective_W.angular)));
  body.setLinearVelocity(body.getLinearVelocity() +
                         toBullet(Vector3(end.linear - ambient.effective_W.linear)));
  ambient.left_W = end;
}

void boundEnergy(AmbientBody& ambient, const Twist& solved_W) noexcept {
  RigidState state = readState(*ambient.body);
  const Quaternion to_body = state.orientation.conjugate();
  const Vector3 flow_W = ambient.def.medium.velocity;
  state.twist.angular = to_body * (solved_W.angular - ambient.turning_W.angular);
  state.twist.linear = to_body * (solved_W.linear - ambient.turning_W.linear - flow_W);
  ambient.energy_bound = inertiaNormSquared(ambient.model, state.twist.vector());
}

void limitEnergy(AmbientBody& ambient) noexcept {
  btRigidBody& body = *ambient.body;
  RigidState state = readState(body);
  const Vector3 flow_W = ambient.def.medium.velocity;
  state.twist.linear -= state.orientation.conjugate() * flow_W;
  const double energy = inertiaNormSquared(ambient.model, state.twist.vector());
  if (!(energy > ambient.energy_bound)) return;
  const double scale = std::sqrt(ambient.energy_bound / energy);
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
