#include "bullet_ambient/motion/flight.h"

#include <cmath>

#include "bullet_ambient/force/buoyancy.h"
#include "bullet_ambient/motion/dormand_prince.h"
#include "bullet_ambient/motion/leapfrog.h"
#include "bullet_ambient/motion/runge_kutta.h"
#include "bullet_ambient/motion/symplectic_euler.h"

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

FlightResult flyBy(const FlightTask& task, const RigidState& start, const FlightMemory& memory) {
  switch (task.settings.integrator) {
    case Integrator::kDormandPrince:
      return flyDormandPrince(task, start, memory);
    case Integrator::kRungeKutta4:
      return flyRungeKutta(task, start);
    case Integrator::kSymplecticEuler:
      return flySymplecticEuler(task, start);
    case Integrator::kPassiveLeapfrog:
      break;
  }
  return flyLeapfrog(task, start, memory);
}

}  // namespace

FlightResult fly(const FlightTask& task, const RigidState& start,
                 const FlightMemory& memory) noexcept {
  const Surroundings& s = task.surroundings;
  RigidState relative = start;
  relative.twist.linear -= start.orientation.conjugate() * s.ambient_velocity;
  FlightResult flight = flyBy(task, relative, memory);
  const double t = task.duration;
  flight.state.position += t * s.ambient_velocity + t * t / 2 * s.ambient_acceleration;
  flight.state.twist.linear +=
      flight.state.orientation.conjugate() * (s.ambient_velocity + t * s.ambient_acceleration);
  return flight;
}

}  // namespace ambient
