#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Response of a body without preferred directions to a wrench: that of the dry body with more
/// mass, and more moments of inertia, each by one factor; docs/theory.md eq. (28b). In B.
struct EvenResponse {
  Matrix3 inverse_inertia{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< [1/(kg m^2)]
  double inverse_mass = 1;                                   ///< [1/kg]

  Vector6 operator*(const Vector6& momentum) const {
    return stack(inverse_inertia * momentum.head<3>(), inverse_mass * momentum.tail<3>());
  }
  /// Its answer to a momentum, less `change`, that of K^-1; zero where this is rounding.
  Vector6 beyond(const Vector6& momentum, const Vector6& change) const;
};

/// The factors are the largest with which either block answers at least as far as that of K^-1
/// does. `dry_inertia`: rotational, of the body without fluid [kg m^2].
EvenResponse makeEvenResponse(const Matrix6& inverse_inertia, const Matrix3& dry_inertia);

}  // namespace ambient
