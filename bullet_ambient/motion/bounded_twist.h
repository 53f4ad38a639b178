#pragma once

#include <cmath>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// A twist after a bound on its energy, and the energy that the bound has removed.
struct BoundedTwist {
  Vector6 twist;
  double energy_removed = 0;  ///< [J]
};

/// Scales a twist down until its energy is the allowed one. Both energies are doubled, as x.K x.
inline BoundedTwist scaledWithin(const Vector6& x, double twice_energy,
                                 double twice_allowed) noexcept {
  if (!(twice_energy > twice_allowed)) return {x, 0};
  return {std::sqrt(twice_allowed / twice_energy) * x, (twice_energy - twice_allowed) / 2};
}

}  // namespace ambient
