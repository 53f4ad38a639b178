#include "bullet_ambient/bullet/solver/flight_queue.h"

#include <utility>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/flight_coupling.h"

AMBIENT_BEGIN

void FlightQueue::fly() noexcept {
  if (const int count = std::exchange(trees_.count, 0))
    flySingleLinks(trees_.flyers, trees_.of, count, time_step_);
  const int count = std::exchange(bodies_.count, 0);
  if (count == 0) return;
  StartStates starts;
  Twist changes_W[kFlightsTogether];
  readStartStates(bodies_.flyers, count, starts);
  beginFlights(bodies_.flyers, starts, count, time_step_, changes_W);
  for (int i = 0; i < count; ++i) {
    addVelocity(*bodies_.flyers[i]->body, changes_W[i]);
    reportFlight(*bodies_.flyers[i], bodies_.of[i]->warnings);
  }
}

AMBIENT_END
