#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// For sources compiled once per instruction set, see spatial_lanes.h, and with one_body.h for ordinary
// ones.

namespace ambient {
namespace {

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
