#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Square roots of the factors on the resistance in creeping flow, Lambda of eq. (113): R becomes
/// Lambda R Lambda about the centre of reaction. Both 0: no resistance.
struct Growth {
  double rotation = 0, translation = 0;
};

/// Growth of the resistance of a body at rest: none.
constexpr Growth kCreeping{1, 1};

/// Resistance in creeping flow of a body in a fluid, mu R.
struct Resistance {
  Matrix6 matrix = Matrix6::Zero();  ///< about `centre`, rotation first [N m s, N s, N s/m]
  Vector3 centre{0, 0, 0};           ///< centre of reaction [m]

  bool isZero() const { return matrix.isZero(0); }
  /// C = Lambda mu R Lambda about the frame's origin, symmetric and positive semi-definite.
  Matrix6 grown(const Growth& growth) const noexcept;
  /// -C x.
  Wrench load(const Growth& growth, const Twist& x) const noexcept;
};

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
