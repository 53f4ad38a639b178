#pragma once

#include "bullet_ambient/motion/spatial_lanes.h"

// See lanes.h for who may include this.

namespace ambient {
namespace {

/// The motions x after `duration` under loads that were evaluated at the motions `at`;
/// passiveKick(), docs/theory.md eq. (23).
inline Pairs passiveKick(const Pairs& x, const Pairs& at, const Pairs& load,
                         const Lanes& duration) {
  const Lanes one = all(1), zero = Lanes{};
  const Lanes energy = inner(at, at);
  const Mask moves = energy > zero;  // else no motion relative to the fluid, no load
  const Lanes per_energy = one / (moves ? energy : one);
  const Lanes n = squareRoot(moves ? energy : one);
  const Lanes per_n = one / n;
  const Lanes along = inner(at, load) * per_energy;
  const Lanes decay = along > zero ? zero : -along;  // a load that is not finite must not look like
                                                     // none

  // Acceleration across the motion: what is left of K^-1 F without its part along the twist.
  const Pairs across = load - along * at;
  const Lanes f = squareRoot(larger(inner(across, across), zero));
  const Lanes per_f = one / (f > zero ? f : one);

  const Lanes speed = squareRoot(larger(inner(x, x), zero)) * per_n;
  const Lanes z = decay * duration * speed;
  const Lanes angle = duration * f * per_n * logarithmRatio(z) * speed;
  const Lanes c1 = inner(x, at) * per_n;
  const Lanes c2 = inner(x, across) * per_f;
  // A rotation whatever the rounding of the tangent.
  const Lanes t = tangent(0.5 * angle);
  const Lanes sine = 2 * t / (1 + t * t);
  const Lanes versine = t * sine;
  const Pairs turned = x + ((-versine * c1 - sine * c2) * per_n) * at +
                       ((sine * c1 - versine * c2) * per_f) * across;
  return select(moves, one / (1 + z) * turned, x);
}

}  // namespace
}  // namespace ambient
