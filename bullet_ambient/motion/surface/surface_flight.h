#pragma once

#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/surface/flotation.h"

namespace ambient {

/// One body near a water surface over one step: its state at the start of the step before
/// flyAtSurface(), at its end afterwards.
struct SurfaceFlight {
  const SurfaceModel& model;
  /// Plane of the surface at the start of the step, in W; only normal and height count. The plane
  /// moves with the water; the normal is against gravity as the water feels it.
  const SurfacePlane& plane_W;
  /// Gravity, forces, and velocity and acceleration of the fluid below at the body.
  const Surroundings& surroundings;
  Vector3 velocity_above;  ///< velocity of the fluid above, world axes [m/s]
  const FlightSettings& settings;
  double duration;    ///< [s], > 0
  VesselWater water;  ///< of the flotation

  FlightResult& body;  ///< twist absolute, in B
  WaveMemory& waves;
  Flotation& flotation;  ///< flotation at the pose of `body`
};

/// Integrates the motion of up to kFlightsTogether bodies that the surface of the water cuts or is
/// near: Kirchhoff's equations with an inertia that depends on the pose, docs/theory.md eq. (62) to
/// (72). Far above and below the surface the motion passes into that of fly() without a jump. In
/// still water without wind and applied torque the energy never grows, however long the step: if no
/// number of substeps keeps it, the motion ends early, FlightCount::halted. The bits of a body do
/// not depend on the other bodies. Allocates nothing. The result is not finite if the input or a
/// load is not: check before use.
void flyAtSurface(SurfaceFlight* const* flights, int count) noexcept;

}  // namespace ambient
