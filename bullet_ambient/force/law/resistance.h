#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Square roots of the factors on the resistance in creeping flow, Lambda of eq. (113): R becomes
/// Lambda R Lambda about the centre of reaction. Both 0: no resistance.
struct Growth {
  double rotation = 0, translation = 0;
};

/// That of a body at rest.
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

}  // namespace ambient
