#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/surface/hydrostatics.h"

namespace ambient {

/// Place of a body relative to the surface of the water; all in the frame of the plane.
struct Immersion {
  SurfacePlane plane;
  double low = 0, high = 0;  ///< smallest and largest s.z over the body [m]
  WetVolume wet;

  double size() const { return high - low; }                  ///< H [m]
  double draught() const { return plane.height - low; }       ///< D, depth of the lowest point [m]
  double submergence() const { return plane.height - high; }  ///< depth of the highest point [m]
  bool isDry() const { return draught() <= 0; }
  /// True if the body is so deep, away from the sides of its pool, that its added mass is that in
  /// unbounded fluid.
  bool isDeep() const { return !plane.sides_F && submergence() >= 2 * size(); }
};

/// Derivatives of an energy T by the place of the plane.
struct InertiaGradient {
  double by_height = 0;        ///< T_h = dT/dh
  Vector3 by_normal{0, 0, 0};  ///< T_s = dT/ds

  /// Wrench F_K of the derivatives: force along s, and torque; docs/theory.md eq. (66).
  Wrench wrench(const SurfacePlane& plane) const {
    return {by_normal.cross(plane.normal), -by_height * plane.normal};
  }
};

/// Added mass of a body near the surface of the water, for fast motions: the potential is 0 on the
/// undisturbed surface. Per unit density, in frame F. Immutable; shared by all bodies of a
/// shape.
class WettedInertia {
 public:
  virtual ~WettedInertia() = default;

  /// K_w, symmetric. Dry body: 0; deep body: FluidBody::added_mass bit for bit. Eigenvalues may be
  /// as low as minus a hundredth of the largest. Allocates nothing.
  Matrix6 inertia(const Immersion& immersion) const noexcept;
  /// K_w without the raised plane of an entering body, docs/theory.md eq. (65).
  Matrix6 unraisedInertia(const Immersion& immersion) const noexcept;
  /// Gradient of 1/2 x.K_w x at constant twist x in F; 0 if the body is dry or deep.
  InertiaGradient gradient(const Immersion& immersion, const Twist& twist) const noexcept;

 protected:
  explicit WettedInertia(const Matrix6& deep) : deep_(deep) {}
  const Matrix6& deep() const { return deep_; }

 private:
  /// K_w for the plane at its raised height, eq. (65). @pre the body is neither dry nor deep
  virtual Matrix6 inertiaAt(const Immersion& raised) const noexcept = 0;
  virtual InertiaGradient gradientAt(const Immersion& raised,
                                     const Twist& twist) const noexcept = 0;

  Matrix6 deep_;
};

/// Share of a body's volume in the water; for a sheet, whose volume is 0, share of its height.
double wetShare(const Immersion& immersion, double volume) noexcept;

/// Added mass of a sphere along the normal of the surface and across, per unit density, in units of
/// radius^3.
struct SphereInertia {
  double along = 0, across = 0;
  double along_slope = 0, across_slope = 0;  ///< derivatives by the depth in radii
};

/// Computes the added mass of a sphere whose lowest point is `depth` radii deep; docs/theory.md
/// section 12. Continuously differentiable in the depth.
SphereInertia sphereInertiaAt(double depth) noexcept;

/// Makes the added mass of a body at the surface of the water. Of a
/// sphere in closed form; with parts of the added mass by these, eq. (60), or with a waterline
/// table, eq. (61a); else the added mass times the wet share of the volume. Cost: O(parts).
std::shared_ptr<const WettedInertia> makeWettedInertia(
    const std::shared_ptr<const FluidBody>& body);

}  // namespace ambient
