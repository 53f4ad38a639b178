#pragma once

#include <cmath>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Twist after a bound on its energy, and the energy removed by the bound.
struct BoundedTwist {
  Vector6 twist;
  double energy_removed = 0;  ///< [J]
};

/// Scales a twist x down to the allowed energy if it has more. Energies are given as x.K x [2 J].
inline BoundedTwist scaledWithin(const Vector6& x, double twice_energy,
                                 double twice_allowed) noexcept {
  if (!(twice_energy > twice_allowed)) return {x, 0};
  return {std::sqrt(twice_allowed / twice_energy) * x, (twice_energy - twice_allowed) / 2};
}

}  // namespace ambient
