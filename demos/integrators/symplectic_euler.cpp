#include <algorithm>

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/spatial/rotation.h"
#include "demos/integrators/integrators.h"

namespace ambient {

FlightResult flySymplecticEuler(const FlightTask& task, const RigidState& start,
                                const FlightMemory&) noexcept {
  const BodyModel& model = task.model;
  FlightResult flight{start, {}, {}};
  flight.count.substeps = std::max(1, task.settings.max_substeps);
  const double h = task.duration / flight.count.substeps;
  RigidState& s = flight.state;
  for (int i = 0; i < flight.count.substeps; ++i) {
    Wrench wrench = externalWrench(model, task.surroundings, s.orientation.toRotationMatrix()) +
                    gyroscopicWrench(pairOfTwist(model, s.twist.vector()));
    if (model.loads) {
      const SurfaceLoad load = computeSurfaceLoad(model, s.twist, task.surroundings);
      ++flight.count.load_evaluations;
      flight.count.guarded += load.guarded;
      wrench += load.wrench;
    }
    s.twist = Twist::fromVector(s.twist.vector() + h * (model.inverse_inertia * wrench.vector()));
    s.orientation = (s.orientation * rotationFromVector(h * s.twist.angular)).normalized();
    s.position += h * (s.orientation * s.twist.linear);
  }
  return flight;
}

}  // namespace ambient
