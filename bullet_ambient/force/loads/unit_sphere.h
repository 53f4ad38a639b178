#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/medium/surface_plane.h"

namespace ambient {

/// Faces spread over the sphere of radius 1 m about the origin, symmetric in all axes. All spheres
/// take the loads on their wet part from these, whatever faces they have. Made once per process.
std::shared_ptr<const FluidBody> unitSphere();

/// Surface of the fluid at a sphere of a radius [m] and a centre in F [m], with lengths in radii
/// about the centre. `plane_at_centre` is in a frame at the centre with the axes of F.
struct PlaneInRadii {
  PlaneInRadii(const SurfacePlane& plane_at_centre, const Vector3& centre, double radius) noexcept;
  PlaneInRadii(const PlaneInRadii&) = delete;  // plane points to sides

  SurfacePlane plane;
  PoolSides sides;
};

}  // namespace ambient
