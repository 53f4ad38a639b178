#pragma once

#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/motion/body/bounded_twist.h"

namespace ambient {

/// The change of the total inertia of a body that passes the surface of the water, over a time in
/// which it moved from one pose to another; in B, at the second pose but for the gradient.
struct SurfacePassage {
  const Matrix6& before;         ///< K_0
  const Matrix6& after;          ///< K_1
  const Matrix6& inverse_after;  ///< K_1^-1
  Wrench gradient;               ///< F_K, of the kinetic energy of the twist before [N]
  Vector3 normal;                ///< of the surface
  Vector3 centre_of_buoyancy;    ///< [m]
  double draught, cover;         ///< of the lowest and of the highest point [m]
  double gravity;                ///< [m/s^2]
  double duration;               ///< [s]
};

/// The twist after the passage, docs/theory.md eq. (66) to (68): momentum of the water goes to the
/// body, from it, or into spray. The kinetic energy x.K x never grows; horizontal momentum and the
/// angular one about the vertical stay but for where that bound acts. @return x for equal inertias.
BoundedTwist passSurface(const SurfacePassage& passage, const Vector6& x) noexcept;

}  // namespace ambient
