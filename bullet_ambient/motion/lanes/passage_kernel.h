#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Passage through the surface of the water, docs/theory.md eq. (66) to (68), one body per lane. For
// sources that are compiled once per instruction set, see spatial_lanes.h.

namespace ambient {
namespace {

/// SurfacePassage of one body per lane; body axes.
struct Passages {
  const FullMatrices &before, &after, &inverse_after;  ///< K_0, K_1, K_1^-1 of eq. (68)
  Spatials gradient;                                   ///< F_K of eq. (66)
  Vectors normal, centre_of_buoyancy;
  Lanes draught, cover;  ///< MeanDepths [m]
  Lanes gravity, duration;
  Lanes fall_scale;  ///< second term of the denominator of eq. (25) [sqrt(J)]
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

/// Works at the twist before the passage [J].
struct PassageWorks {
  Lanes of_gradient;  ///< F_K . x dt
  Lanes of_change;    ///< half of x . (K_1 - K_0) x
};

/// Returns F_K dt. The force is multiplied by r of eq. (68), so that its work equals the change of
/// the kinetic energy by that of K, if r is between 0 and 3. The torque stays, because it belongs
/// to the gyroscopic terms of the flow.
inline Spatials impulseOf(const Passages& p, const PassageWorks& works) {
  constexpr double kMostCorrection = 3;
  const Lanes one = all(1);
  const Lanes ratio = works.of_change / works.of_gradient;
  const Mask is_near = (ratio > Lanes{}) & (ratio < all(kMostCorrection));
  return {p.duration * p.gradient.angular,
          (p.duration * (is_near ? ratio : one)) * p.gradient.linear};
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

struct PassedTwists {
  BoundedTwists end;
  Lanes error;  ///< relative to the motion, eq. (68b) [1]
};

/// Scales x so that twice its energy, `twice_energy`, does not exceed `twice_allowed` [J].
inline BoundedTwists scaledWithin(const Spatials& x, const Lanes& twice_energy,
                                  const Lanes& twice_allowed) {
  const Lanes one = all(1), zero = Lanes{};
  const Mask gains = twice_energy > twice_allowed;
  const Lanes scale = squareRoot(gains ? twice_allowed / (gains ? twice_energy : one) : one);
  return {scale * x, gains ? 0.5 * (twice_energy - twice_allowed) : zero};
}

/// Returns eq. (68b): the velocity that F_K of one pose misses, over the motion. `twice_energy`:
/// x . K_0 x.
inline Lanes passageError(const Passages& p, const PassageWorks& works, const Lanes& spray_share,
                          const Lanes& twice_energy) {
  const Lanes norm = squareRoot(twice_energy), scale = norm * (norm + p.fall_scale);
  const Lanes missed = (1 - spray_share) * (works.of_change - works.of_gradient);
  const Mask moves = scale > Lanes{};
  return moves ? larger(missed, -missed) / (moves ? scale : all(1)) : Lanes{};
}

/// Returns the twists after the passage, eq. (67) and (68), the energy removed [J] and the error.
/// Bodies whose K has not changed keep their twists.
inline PassedTwists passSurface(const Passages& p, const Spatials& x) {
  constexpr double kRounding = 1e-12;
  const FullMatrices change = p.after - p.before;
  const Mask changes = largestEntry(change) >= kRounding * largestEntry(p.before);
  const PassageWorks works{p.duration * dot(p.gradient, x), 0.5 * dot(x, change * x)};
  Spatials impulse = impulseOf(p, works);
  const Lanes spray_share = sprayShare(p, x);
  const Lanes lost = spray_share * larger(Lanes{} - dot(p.normal, impulse.linear), Lanes{});
  impulse = impulse + lost * Spatials{cross(p.centre_of_buoyancy, p.normal), p.normal};
  const Spatials momentum = p.before * x;
  const Spatials end = p.inverse_after * (momentum + impulse);
  const Lanes twice_energy = dot(x, momentum);
  const BoundedTwists bounded = scaledWithin(end, dot(end, p.after * end), twice_energy);
  return {{select(changes, bounded.twist, x), changes ? bounded.energy_removed : Lanes{}},
          changes ? passageError(p, works, spray_share, twice_energy) : Lanes{}};
}

}  // namespace
}  // namespace ambient
