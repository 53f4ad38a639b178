#pragma once

#include <cmath>

#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Vector x and its image K x under the inertia: a twist and its momentum, or an acceleration and
/// its wrench; in B. Inner products a.K b of pairs need no multiplication by K.
/// `twist`: x; `momentum`: K x.
struct DualPair {
  Vector6 twist = Vector6::Zero();
  Vector6 momentum = Vector6::Zero();
};

/// Inner product a.K b.
inline double inner(const DualPair& a, const DualPair& b) { return a.twist.dot(b.momentum); }

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
