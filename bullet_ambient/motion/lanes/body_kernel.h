#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// For sources compiled once per instruction set, see spatial_lanes.h, and with one_body.h for
// ordinary ones.

namespace ambient {

namespace {

/// Returns the motions `x` after `duration` [s] under `load`, docs/theory.md eq. (23). `load`: K^-1
/// F and F of the loads F evaluated at the motions `at`.
inline Pairs passiveKick(const Pairs& x, const Pairs& at, const Pairs& load,
                         const Lanes& duration) {
  const Lanes one = all(1), zero = Lanes{};
  const Lanes energy = inner(at, at);
  const Mask moves = energy > zero;  // at rest relative to the fluid there is no load
  const Lanes per_energy = one / (moves ? energy : one);
  const Lanes n = squareRoot(moves ? energy : one);
  const Lanes per_n = one / n;
  const Lanes along = inner(at, load) * per_energy;
  const Lanes decay = along > zero ? zero : -along;  // NaN of a load that is not finite stays NaN,
                                                     // because NaN > 0 is false

  // Lift: K^-1 F minus its part along the twist.
  const Pairs across = load - along * at;
  const Lanes f = squareRoot(larger(inner(across, across), zero));
  const Lanes per_f = one / (f > zero ? f : one);

  const Lanes speed = squareRoot(larger(inner(x, x), zero)) * per_n;
  const Lanes z = decay * duration * speed;
  const Lanes angle = duration * f * per_n * logarithmRatio(z) * speed;
  const Lanes c1 = inner(x, at) * per_n;
  const Lanes c2 = inner(x, across) * per_f;
  // Sine and versine from one tangent: a rotation for any rounding of the tangent.
  const Lanes t = tangent(0.5 * angle);
  const Lanes sine = 2 * t / (1 + t * t);
  const Lanes versine = t * sine;
  const Pairs turned = x + ((-versine * c1 - sine * c2) * per_n) * at +
                       ((sine * c1 - versine * c2) * per_f) * across;
  return select(moves, one / (1 + z) * turned, x);
}

/// Returns the extents m of turns, docs/theory.md eq. (28a): the larger of |w| / spin and
/// (|t| / |x|) / largest_change. `change`: pairs of t; `motion`: pairs of x.
inline Lanes extentOf(const Pairs& change, const Pairs& motion, const Lanes& spin,
                      const Lanes& largest_change) {
  const Lanes zero = Lanes{};
  const Lanes energy = inner(motion, motion);
  const Mask moves = energy > zero;
  const Lanes part_sq = larger(inner(change, change), zero) / (moves ? energy : all(1));
  const Lanes part = moves ? squareRoot(part_sq) : zero;
  const Vectors& w = motion.twist.angular;
  return larger(part / largest_change, squareRoot(dot(w, w)) / spin);
}

/// Turning part t of eq. (28) over a step, in B, and its extent.
struct Turnings {
  Spatials change;
  Lanes extent;
};

/// Computes the turnings of free bodies explicitly. `motion`: relative to the flow; duration [s].
template <class Matrices>
Turnings computeTurnings(const Matrices& inertia, const Matrices& inverse, const Pairs& motion,
                         const Lanes& duration) {
  const Spatials &x = motion.twist, &m = motion.momentum;
  const Spatials wrench{cross(m.angular, x.angular) + cross(m.linear, x.linear),
                        cross(m.linear, x.angular)};  // eq. (2)
  Spatials change = duration * (inverse * wrench);
  change.linear = change.linear + duration * cross(x.angular, x.linear);
  const Lanes extent = extentOf({change, inertia * change}, motion, 0.5 / duration, all(0.45));
  return {change, extent};
}

}  // namespace

}  // namespace ambient
