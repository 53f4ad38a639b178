#pragma once

#include "bullet_ambient/force/wetted_inertia.h"

namespace ambient {

/// Along the normal of the surface and across it, in radii cubed, over the depth of the lowest
/// point.
struct SphereInertia {
  double along = 0, across = 0;
  double along_slope = 0, across_slope = 0;  ///< per radius of depth
};

/// Of a sphere at the surface whose lowest point is `depth` radii deep; docs/theory.md, "Added mass
/// of a sphere at the surface". Continuously differentiable.
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
