#include "bullet_ambient/motion/flight.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/force/buoyancy.h"
#include "bullet_ambient/motion/integrators.h"

namespace ambient {

Wrench externalWrench(const BodyModel& model, const Surroundings& surroundings, const Matrix3& R) {
  const auto to_body = R.transpose();
  const Vector3 force = surroundings.applied.force - model.mass * surroundings.ambient_acceleration;
  const Vector3 gravity = to_body * (surroundings.gravity - surroundings.ambient_acceleration);
  return Wrench{to_body * surroundings.applied.torque, to_body * force} +
         buoyancy(model.displaced_mass, model.centre_of_volume, gravity);
}

double fallScale(const FlightTask& task) {
  const BodyModel& model = task.model;
  const Surroundings& s = task.surroundings;
  const double pull = (s.applied.force / model.mass - s.ambient_acceleration).norm();
  return std::sqrt(model.largest_mass * pull * model.reference_length);
}

namespace {

// Into the frame that moves with the ambient flow, and back.
void enterFrame(const Surroundings& s, RigidState& state) {
  state.twist.linear -= state.orientation.conjugate() * s.ambient_velocity;
}
void leaveFrame(const Surroundings& s, double t, RigidState& state) {
  state.position += t * s.ambient_velocity + t * t / 2 * s.ambient_acceleration;
  state.twist.linear +=
      state.orientation.conjugate() * (s.ambient_velocity + t * s.ambient_acceleration);
}

bool isFluidAtRest(const Surroundings& s) {
  return s.ambient_velocity.isZero(0) && s.ambient_acceleration.isZero(0);
}

FlightResult flyAlone(const FlightTask& task, const FlightResult& start) {
  switch (task.settings.integrator) {
    case Integrator::kDormandPrince:
      return flyDormandPrince(task, start.state, start.memory);
    case Integrator::kRungeKutta4:
      return flyRungeKutta(task, start.state);
    case Integrator::kSymplecticEuler:
      return flySymplecticEuler(task, start.state);
    case Integrator::kPassiveLeapfrog:
      break;
  }
  return start;
}

// Up to kFlightsTogether, in frames that move with the flow.
void flyGroup(Flight* const* flights, int count) {
  Flight* leaps[kFlightsTogether];
  int leap_count = 0;
  for (int i = 0; i < count; ++i) {
    Flight& flight = *flights[i];
    if (flight.task.settings.integrator == Integrator::kPassiveLeapfrog) {
      leaps[leap_count++] = &flight;
    } else {
      flight.body = flyAlone(flight.task, flight.body);
    }
  }
  if (leap_count > 0) flyLeapfrog(leaps, leap_count);
}

}  // namespace

void flyTogether(Flight* const* flights, int count) noexcept {
  for (int i = 0; i < count; ++i) {
    const Surroundings& s = flights[i]->task.surroundings;
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
