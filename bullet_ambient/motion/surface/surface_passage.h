#pragma once

#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/motion/body/dual_pair.h"

namespace ambient {

/// Passage of a body through the water surface, from one pose to another: change of its total
/// inertia, and geometry. In B at the second pose; the gradient may be that of the first pose.
struct SurfacePassage {
  const Matrix6& before;         ///< K_0
  const Matrix6& after;          ///< K_1
  const Matrix6& inverse_after;  ///< K_1^-1
  Wrench gradient;               ///< F_K of docs/theory.md eq. (66), for the twist before [N m, N]
  Vector3 normal;                ///< unit normal of the surface, out of the water
  Vector3 centre_of_buoyancy;    ///< [m]
  double draught, cover;         ///< MeanDepths [m]
  double gravity;                ///< [m/s^2]
  double duration;               ///< [s]
};

/// Computes the twist after the passage from the twist x before, docs/theory.md eq. (66) to (68):
/// momentum passes between water and body, or into spray. The kinetic energy x.K x never grows.
/// Horizontal momentum, and angular momentum about the vertical, are kept unless this bound acts.
/// @return x if the inertias are equal
BoundedTwist passSurface(const SurfacePassage& passage, const Vector6& x) noexcept;

}  // namespace ambient
