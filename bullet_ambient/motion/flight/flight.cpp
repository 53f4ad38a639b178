#include "bullet_ambient/motion/flight/flight.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

namespace {

// Conversions to the frame that moves with the ambient flow, and after time t [s] back to W.
void enterFrame(const Surroundings& s, RigidState& state) {
  state.twist.linear -= state.orientation.conjugate() * s.ambient_velocity;
}
void leaveFrame(const Surroundings& s, double t, RigidState& state) {
  state.position += t * s.ambient_velocity + t * t / 2 * s.ambient_acceleration;
  state.twist.linear +=
      state.orientation.conjugate() * (s.ambient_velocity + t * s.ambient_acceleration);
}

bool isFluidAtRest(const Surroundings& s) {
  return s.ambient_velocity.cwiseAbs().sum() + s.ambient_acceleration.cwiseAbs().sum() == 0;
}

// Moves up to kFlightsTogether bodies, whose states are in the frames that move with the flow.
void flyGroup(Flight* const* flights, int count) {
  Flight* leaps[kFlightsTogether];
  int leap_count = 0;
  for (int i = 0; i < count; ++i) {
    Flight& flight = *flights[i];
    if (const OwnFlight own = flight.task.settings.own_flight) {
      flight.body = own(flight.task, flight.body.state, flight.body.memory);
    } else {
      leaps[leap_count++] = &flight;
    }
  }
  if (leap_count > 0) flyLeapfrog(leaps, leap_count);
}

}  // namespace

void flyTogether(Flight* const* flights, int count) noexcept {
  for (int i = 0; i < count; ++i) {
    const Surroundings& s = flights[i]->task.surroundings;
    AMBIENT_ASSERT(flights[i]->task.duration > 0 && flights[i]->task.settings.tolerance > 0);
    if (!isFluidAtRest(s)) enterFrame(s, flights[i]->body.state);
  }
  for (int i = 0; i < count; i += kFlightsTogether)
    flyGroup(flights + i, std::min(kFlightsTogether, count - i));
  for (int i = 0; i < count; ++i) {
    const FlightTask& task = flights[i]->task;
    if (!isFluidAtRest(task.surroundings))
      leaveFrame(task.surroundings, task.duration, flights[i]->body.state);
  }
}

FlightResult fly(const FlightTask& task, const RigidState& start,
                 const FlightMemory& memory) noexcept {
  Flight flight(task, start, memory);
  Flight* const flights[] = {&flight};
  flyTogether(flights, 1);
  return flight.body;
}

}  // namespace ambient
