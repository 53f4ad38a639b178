#pragma once

#include <limits>
#include <utility>

#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

class DensityLayers;

/// Section of a body with the water surface.
struct Waterplane {
  double area = 0;                   ///< A_w [m^2]; 0: no section, or a negligible one
  Vector3 centroid{0, 0, 0};         ///< [m]
  Matrix3 spread = Matrix3::Zero();  ///< int r r^T dA, r from the centroid; spread s = 0 [m^4]
};

/// Part of a body below the water surface, in the frame of the plane; docs/theory.md eq. (53),
/// (54).
struct WetVolume {
  double volume = 0;          ///< V [m^3]
  Vector3 moment{0, 0, 0};    ///< S = int z dV [m^4]
  double depth_integral = 0;  ///< W = int zeta dV [m^4]; rho g W is the energy of the buoyancy
  Waterplane waterplane;

  /// Converts to frame B; `frame`: pose in B of the present frame.
  WetVolume inB(const FrameOffset& frame) const;
};

/// Computes the wet volume exactly, by the divergence theorem over the wet parts of the triangles.
/// Cost: O(triangles near the plane), with SurfacePlane::sides_F O(triangles); allocates nothing.
/// Bits do not depend on the machine. @pre where the plane has sides, it is in F
WetVolume computeWetVolume(const PackedHull& hull, const SurfacePlane& plane) noexcept;

/// Wrench by which the water presses a body that lies across the sides of its pool out of it,
/// about F's origin [N m, N]; docs/theory.md eq. (90). @pre the plane has sides, and is in F
Wrench computeSidePush(const PackedHull& hull, const SurfacePlane& plane) noexcept;

/// Smallest and largest s.z over the body [m], for a unit vector s; 0 without corners.
std::pair<double, double> computeExtent(const PackedHull& hull, const Vector3& s) noexcept;

/// Computes the wet volume of a sphere in closed form; radius and centre [m].
WetVolume computeWetSphere(double radius, const Vector3& centre,
                           const SurfacePlane& plane) noexcept;

/// Wrench of the hydrostatic pressure on the wet part about the frame's origin: rho g V s at the
/// centre of buoyancy S/V, docs/theory.md eq. (53).
inline Wrench hydrostaticWrench(const WetVolume& wet, const SurfacePlane& plane) noexcept {
  const Vector3 specific_weight = plane.density * plane.gravity * plane.normal;
  return {wet.moment.cross(specific_weight), wet.volume * specific_weight};
}

/// Energy of the buoyancy, rho g W [J].
inline double hydrostaticEnergy(const WetVolume& wet, const SurfacePlane& plane) noexcept {
  return plane.density * plane.gravity * wet.depth_integral;
}

/// Returns that energy at the plane `near` less that at `plane`, to which the wet volume belongs;
/// to second order in the way between them, docs/theory.md eq. (53a) [J].
double hydrostaticEnergyChange(const WetVolume& wet, const SurfacePlane& plane,
                               const SurfacePlane& near) noexcept;

/// Buoyancy of a submerged body: force -m_f g at the centre of volume, docs/theory.md eq. (18).
/// `displaced_mass` m_f = rho V [kg]; `centre_of_volume` [m] and `gravity` [m/s^2] in one frame.
/// The wrench is in the same frame. In a fluid that accelerates by a, pass g - a as
/// gravity, eq. (19).
inline Wrench buoyancy(double displaced_mass, const Vector3& centre_of_volume,
                       const Vector3& gravity) noexcept {
  return Wrench::ofForceAt(-displaced_mass * gravity, centre_of_volume);
}

/// Weight m_b g [N] at the centre of mass, which is the frame's origin: no torque. Gravity does not
/// act on the added mass.
inline Wrench weight(double mass, const Vector3& gravity) noexcept {
  return {Vector3::Zero(), mass * gravity};
}

/// Body in a fluid in layers. Frame F.
struct LayeredBody {
  const FluidBody& shape;
  const PackedHull* hull;    ///< null: a sphere
  Vector3 up{0, 0, 1};       ///< of the layers, in F
  double origin_height = 0;  ///< of F's origin along it, as the layers count heights [m]
  /// Height along it of the surface of the fluid [m]; infinite: it is all around the body.
  double surface = std::numeric_limits<double>::infinity();
};

/// Fluid that a body displaces beyond that of a constant density.
struct ExcessFluid {
  double mass = 0;          ///< [kg]
  Vector3 moment{0, 0, 0};  ///< int z dm, in F [kg m]
};

/// Computes int (rho - reference) dV and its first moment over the part of a body below the surface
/// of the fluid, docs/theory.md eq. (180). Exact where the density is linear over all of the body,
/// by its second moments (FluidBody::uniform_mass, if that is known), and for spheres, and upright
/// boxes and cylinders. Else the mass errs by less than 1e-3, and the moment over the body's length
/// by less than 3e-3, of its volume times the difference of the densities that it meets. A body
/// without triangles has the density at its centre. Cost: four of computeWetVolume() for each piece
/// of the layers that the body reaches into. Allocates nothing.
ExcessFluid findExcessFluid(const LayeredBody& body, const DensityLayers& layers,
                            double reference) noexcept;

}  // namespace ambient
