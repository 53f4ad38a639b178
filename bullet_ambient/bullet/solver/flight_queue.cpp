#include "bullet_ambient/bullet/solver/flight_queue.h"

#include <utility>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"

AMBIENT_BEGIN

void FlightQueue::fly() noexcept {
  if (const int count = std::exchange(trees_.count, 0))
    flySingleLinks(trees_.members, trees_.of, count, time_step_);
  const int count = std::exchange(bodies_.count, 0);
  if (count == 0) return;
  StartStates starts;
  Twist changes_W[kFlightsTogether];
  readStartStates(bodies_.members, count, starts);
  beginFlights(bodies_.members, starts, count, time_step_, changes_W);
  for (int i = 0; i < count; ++i) {
    addVelocity(*bodies_.members[i]->body, changes_W[i]);
    reportFlight(*bodies_.members[i], bodies_.of[i]->complaints);
  }
}

AMBIENT_END
