#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// A surface load without positive power.
struct SurfaceLoad {
  Wrench wrench;
  bool guarded = false;  ///< power had to be taken away
};

/// Removes from the surface wrench (pressure and friction) the part that feeds energy to the body,
/// in the metric of the total inertia K: F' = F - max(0, P) / (x.K x) K x with P = F.x, so that
/// F'.x <= 0 up to rounding and K^-1 (F' - F) is the smallest change of acceleration that does it;
/// docs/theory.md eq. (20). For separation angles above pi/2 the model can gain energy on
/// blunt-based bodies. All in one frame, x relative to the ambient flow; the wrench stays as it is
/// for x = 0 and for anything not finite.
/// @pre inertia is symmetric positive definite.
SurfaceLoad removePositivePower(const Wrench& surface_wrench, const Twist& relative_twist,
                                const Matrix6& inertia) noexcept;

}  // namespace ambient
