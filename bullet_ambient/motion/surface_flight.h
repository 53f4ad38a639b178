#pragma once

#include "bullet_ambient/motion/body_waves.h"
#include "bullet_ambient/motion/flight.h"
#include "bullet_ambient/motion/surface_stand.h"

namespace ambient {

/// One body near a water surface over one step.
struct SurfaceTask {
  const SurfaceModel& model;
  /// Where the surface is at the start of the step, in W: normal and height count; it moves with
  /// the water. Its normal is against gravity as the water feels it.
  const SurfacePlane& plane_W;
  /// Of the fluid below: its velocity and acceleration at the body.
  const Surroundings& surroundings;
  Vector3 velocity_above;  ///< of the fluid above [m/s]
  const FlightSettings& settings;
  double duration;  ///< [s], > 0
  /// At the start of the step: that of the plane there, or of the last flight if it ended there.
  const SurfaceStand& stand;
};

struct SurfaceFlightResult {
  FlightResult flight;
  WaveMemory waves;
  SurfaceStand stand;  ///< at the end
};

/// Integrates the motion of a body that the surface of the water cuts, or is near of: Kirchhoff's
/// equations with an inertia that depends on the pose, docs/theory.md eq. (62) to (72), from
/// `start` (twist absolute, in B). Between bodies above and below the surface and this one there is
/// no jump. In still water without wind and applied torque the energy never grows, however long the
/// step: where no number of substeps keeps it, the motion ends early, FlightCount::halted.
/// Allocates nothing. The result is not finite if the input or a load is not: check before
/// use.
SurfaceFlightResult flyAtSurface(const SurfaceTask& task, const RigidState& start,
                                 const FlightMemory& memory, const WaveMemory& waves) noexcept;

}  // namespace ambient
