#pragma once

#include "bullet_ambient/force/law/resistance.h"

namespace ambient {

/// Surface load whose power is not positive, as SplitLoad.
struct SurfaceLoad {
  Wrench wrench;
  bool guarded = false;  ///< true if power was removed
  Growth growth{};       ///< of the resistance, which acts besides
};

/// Removes from the surface wrench F (pressure and friction) the part that feeds energy to the
/// body: F' = F - max(0, P) / (x.K x) K x, P = F.x, K the total inertia; docs/theory.md eq. (20).
/// Then F'.x <= 0 up to rounding. K^-1 (F' - F) is the smallest such change in the norm of K.
/// Needed for separation angles above pi/2, at which blunt-based bodies could gain energy. All
/// arguments in one frame; x relative to the ambient flow. Returns F unchanged for x = 0 and for
/// input that is not finite.
/// @pre inertia is symmetric positive definite.
SurfaceLoad removePositivePower(const Wrench& surface_wrench, const Twist& relative_twist,
                                const Matrix6& inertia) noexcept;

}  // namespace ambient
