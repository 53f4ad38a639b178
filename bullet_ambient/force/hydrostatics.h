#pragma once

#include <utility>

#include "bullet_ambient/fluid_body/packed_hull.h"
#include "bullet_ambient/force/surface_plane.h"

namespace ambient {

/// The section of a body with the water surface.
struct Waterplane {
  double area = 0;                   ///< A_w [m^2]; 0: there is none, or it is negligible
  Vector3 centroid{0, 0, 0};         ///< [m]
  Matrix3 spread = Matrix3::Zero();  ///< int r r^T dA, r from the centroid; along s zero [m^4]
};

/// The part of a body below the water surface, in the frame of the plane that cuts it;
/// docs/theory.md eq. (53), (54).
struct WetVolume {
  double volume = 0;          ///< V [m^3]
  Vector3 moment{0, 0, 0};    ///< S = int z dV [m^4]
  double depth_integral = 0;  ///< W = int zeta dV [m^4]; rho g W is the energy of the buoyancy
  Waterplane waterplane;

  /// In the frame B in which that of the hull has the pose `frame`.
  WetVolume inB(const FrameOffset& frame) const;
};

/// By the divergence theorem over the wet parts of the triangles, exact. Cost: that of the
/// triangles near the plane; allocates nothing. The same bits on every machine.
WetVolume computeWetVolume(const PackedHull& hull, const SurfacePlane& plane) noexcept;

/// Least and largest s.z over the body [m], for a unit vector s; 0 without corners.
std::pair<double, double> computeExtent(const PackedHull& hull, const Vector3& s) noexcept;

/// Of a sphere, in closed form.
WetVolume computeWetSphere(double radius, const Vector3& centre,
                           const SurfacePlane& plane) noexcept;

/// Hydrostatic pressure on the wet part, docs/theory.md eq. (53): rho g V s at the centre of
/// buoyancy S/V; the gradient of the energy rho g W. About the frame's origin.
inline Wrench hydrostaticWrench(const WetVolume& wet, const SurfacePlane& plane) noexcept {
  const Vector3 pull = plane.density * plane.gravity * plane.normal;
  return {wet.moment.cross(pull), wet.volume * pull};
}

/// rho g W [J]
inline double hydrostaticEnergy(const WetVolume& wet, const SurfacePlane& plane) noexcept {
  return plane.density * plane.gravity * wet.depth_integral;
}

}  // namespace ambient
