#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/loads/surface_loads.h"

namespace ambient {

/// Faces spread over the sphere of radius 1 m about the origin, symmetric in all axes. All spheres
/// take the loads on their wet part from these, whatever faces they have. Made once per process.
std::shared_ptr<const FluidBody> unitSphere();

/// Makes the loads on a sphere that the surface of its fluid may cut. `on_unit`: those on
/// unitSphere() in a fluid with the viscosity over R. With lengths in radii forces grow by R^2,
/// torques by R^3.
std::shared_ptr<const SurfaceLoads> makeWetSphereLoads(std::shared_ptr<const SurfaceLoads> on_unit,
                                                       const FluidBody& sphere);

}  // namespace ambient
