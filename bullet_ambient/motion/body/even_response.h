#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Response to a wrench with isotropic added mass: D' of docs/theory.md eq. (28b), in B. It is the
/// response of the dry body with mass and moments of inertia scaled by one factor each.
struct EvenResponse {
  Matrix3 inverse_inertia{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< [1/(kg m^2)]
  double inverse_mass = 1;                                   ///< [1/kg]

  Vector6 operator*(const Vector6& momentum) const {
    return stack(inverse_inertia * momentum.head<3>(), inverse_mass * momentum.tail<3>());
  }
  /// D' times `momentum`, minus `change` = K^-1 `momentum`: k' - k; 0 if it is only rounding.
  Vector6 beyond(const Vector6& momentum, const Vector6& change) const;
};

/// Computes D'. Its blocks are the smallest that are no smaller than those of K^-1 in any
/// direction. `dry_inertia`: rotational inertia of the body without fluid [kg m^2].
EvenResponse makeEvenResponse(const Matrix6& inverse_inertia, const Matrix3& dry_inertia);

}  // namespace ambient
