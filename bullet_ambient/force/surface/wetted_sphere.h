#pragma once

#include "bullet_ambient/force/surface/wetted_inertia.h"

namespace ambient {

/// Added mass of a sphere along the normal of the surface and across, per unit density, in units of
/// radius^3.
struct SphereInertia {
  double along = 0, across = 0;
  double along_slope = 0, across_slope = 0;  ///< derivatives by the depth in radii
};

/// Computes the added mass of a sphere whose lowest point is `depth` radii deep; docs/theory.md
/// section 12. Continuously differentiable in the depth.
SphereInertia sphereInertiaAt(double depth) noexcept;

/// Added mass of a sphere at the surface.
class WettedSphere final : public WettedInertia {
 public:
  explicit WettedSphere(const FluidBody& body);

 private:
  Matrix6 inertiaAt(const Immersion& raised) const noexcept override;
  InertiaGradient gradientAt(const Immersion& raised, const Twist& twist) const noexcept override;

  Vector3 centre_;
  double radius_;
};

}  // namespace ambient
