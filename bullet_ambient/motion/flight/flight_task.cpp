#include "bullet_ambient/motion/flight/flight_task.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

Wrench externalWrench(const BodyModel& model, const Surroundings& surroundings, const Matrix3& R) {
  AMBIENT_ASSERT(isRotation(R));
  const auto to_body = R.transpose();
  const Vector3 force = surroundings.applied.force - model.mass * surroundings.ambient_acceleration;
  const Vector3 gravity = to_body * (surroundings.gravity - surroundings.ambient_acceleration);
  return Wrench{to_body * surroundings.applied.torque, to_body * force} +
         buoyancy(model.displaced_mass, model.centre_of_volume, gravity);
}

double energyOfPlace(const BodyModel& model, const Surroundings& surroundings,
                     const FrameOffset& place, double of_water) {
  const Vector3 force = surroundings.applied.force - model.mass * surroundings.ambient_acceleration;
  const Vector3 buoyancy =
      -model.displaced_mass * (surroundings.gravity - surroundings.ambient_acceleration);
  const Vector3 arm = place.translation + place.rotation * model.centre_of_volume;
  return of_water - force.dot(place.translation) - buoyancy.dot(arm);
}

double fallScale(const FlightTask& task) {
  const BodyModel& model = task.model;
  const Surroundings& s = task.surroundings;
  const double pull = (s.applied.force / model.mass - s.ambient_acceleration).norm();
  AMBIENT_ASSERT(model.mass > 0 && model.largest_mass > 0);
  return std::sqrt(model.largest_mass * pull * model.reference_length);
}

}  // namespace ambient
