#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Passage through the surface of the water, docs/theory.md eq. (66) to (68), one body per lane. For
// sources that are compiled once per instruction set, see lanes.h.

namespace ambient {
namespace {

/// SurfacePassage of one body per lane; body axes.
struct Passages {
  const FullMatrices &before, &after, &inverse_after;  ///< K_0, K_1, K_1^-1 of eq. (68)
  Spatials gradient;                                   ///< F_K of eq. (66)
  Vectors normal, centre_of_buoyancy;
  Lanes draught, cover;  ///< depth of the lowest and of the highest point [m]
  Lanes gravity, duration;
};

/// Returns theta sigma of eq. (67), the share of the momentum that goes into spray, in [-1, 1].
inline Lanes sprayShare(const Passages& p, const Spatials& x) {
  const Lanes zero = Lanes{}, one = all(1);
  const Vectors v = x.linear + cross(x.angular, p.centre_of_buoyancy);
  const Lanes sinking = zero - dot(p.normal, v), speed = squareRoot(dot(v, v));
  const Lanes still = sinking * sinking + p.gravity * p.draught;
  const Mask moves = (speed > zero) & (still > zero) & (p.draught > zero);
  const Lanes open = 1 - 4 * larger(p.cover, zero) / (moves ? p.draught : one);
  const Lanes open_share = larger(open < one ? open : one, zero);
  const Lanes theta = sinking * sinking / (moves ? still : one) * open_share;
  const Lanes down = 2 * sinking / (moves ? speed : one);
  const Lanes sigma = larger(down < one ? down : one, -one);
  return moves ? theta * sigma : zero;
}

/// Returns F_K dt. The force is multiplied by r of eq. (68), so that its work equals the change of
/// the kinetic energy by that of K, if r is between 0 and 3. The torque stays, because it belongs
/// to the gyroscopic terms of the flow.
inline Spatials impulseOf(const Passages& p, const FullMatrices& change, const Spatials& x) {
  constexpr double kMostCorrection = 3;
  const Lanes one = all(1);
  const Lanes work = p.duration * dot(p.gradient, x);
  const Lanes ratio = 0.5 * dot(x, change * x) / work;
  const Mask is_near = (ratio > Lanes{}) & (ratio < all(kMostCorrection));
  return {p.duration * p.gradient.angular,
          (p.duration * (is_near ? ratio : one)) * p.gradient.linear};
}

/// Returns K_1 - K_0.
inline FullMatrices changeOf(const Passages& p) {
  FullMatrices change;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) change.entry(i, j) = p.after.entry(i, j) - p.before.entry(i, j);
  return change;
}

inline Lanes largestEntry(const FullMatrices& K) {
  Lanes largest = Lanes{};
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) largest = larger(larger(K.entry(i, j), -K.entry(i, j)), largest);
  return largest;
}

struct BoundedTwists {
  Spatials twist;
  Lanes energy_removed;
};

/// Scales x so that twice its energy, `twice_energy`, does not exceed `twice_allowed` [J].
inline BoundedTwists scaledWithin(const Spatials& x, const Lanes& twice_energy,
                                  const Lanes& twice_allowed) {
  const Lanes one = all(1), zero = Lanes{};
  const Mask gains = twice_energy > twice_allowed;
  const Lanes scale = squareRoot(gains ? twice_allowed / (gains ? twice_energy : one) : one);
  return {scale * x, gains ? 0.5 * (twice_energy - twice_allowed) : zero};
}

/// Returns the twists after the passage, eq. (67) and (68), and the energy removed [J]. Bodies
/// whose K has not changed keep their twists.
inline BoundedTwists passSurface(const Passages& p, const Spatials& x) {
  constexpr double kRounding = 1e-12;
  const FullMatrices change = changeOf(p);
  const Mask changes = largestEntry(change) >= kRounding * largestEntry(p.before);
  Spatials impulse = impulseOf(p, change, x);
  const Lanes lost = sprayShare(p, x) * larger(Lanes{} - dot(p.normal, impulse.linear), Lanes{});
  impulse = impulse + lost * Spatials{cross(p.centre_of_buoyancy, p.normal), p.normal};
  const Spatials momentum = p.before * x;
  const Spatials end = p.inverse_after * (momentum + impulse);
  const BoundedTwists bounded = scaledWithin(end, dot(end, p.after * end), dot(x, momentum));
  return {select(changes, bounded.twist, x), changes ? bounded.energy_removed : Lanes{}};
}

}  // namespace
}  // namespace ambient
