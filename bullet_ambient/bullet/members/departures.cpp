#include "bullet_ambient/bullet/members/departures.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/motion/flight/flight_group.h"

AMBIENT_BEGIN

void readAttitudes(AmbientBody* const* bodies, const Twist* twists_W, int count,
                   Attitudes& attitudes) noexcept {
  AMBIENT_ASSERT(count > 0 && count <= kFlightsTogether);
  DepartureLanes lanes{};
  for (int i = 0; i < count; ++i) {
    const btMatrix3x3& rotation = bodies[i]->body->getWorldTransform().getBasis();
    for (int row = 0; row < 3; ++row)
      setLane(lanes.rotation + 3 * row, i, toVector3(rotation[row]));
    setLane(lanes.twist_W, i, twists_W[i]);
  }
  fastestFlightKernel().depart(lanes);
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

AMBIENT_END
