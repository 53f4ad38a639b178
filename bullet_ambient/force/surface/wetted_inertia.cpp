#include "bullet_ambient/force/surface/wetted_inertia.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

/// Rise of the water around an entering body [m], docs/theory.md eq. (65), and its derivative by
/// the height of the plane [1].
struct PileUp {
  double rise = 0, slope = 0;

  explicit PileUp(const Immersion& at) {
    constexpr double kPileUp = 0.4;
    if (!(at.draught() < at.size())) return;
    const double wet = at.draught() / at.size(), dry = 1 - wet;
    const double dry7 = dry * dry * dry * (dry * dry) * (dry * dry);
    rise = kPileUp * dry7 * dry * at.draught();
    slope = kPileUp * dry7 * (dry - 8 * wet);
  }
};

Immersion raised(const Immersion& immersion, const PileUp& pile_up) {
  Immersion result = immersion;
  result.plane.height += pile_up.rise;
  return result;
}

}  // namespace

double wetShare(const Immersion& immersion, double volume) noexcept {
  AMBIENT_ASSERT(volume >= 0 && !(immersion.low > immersion.high));
  const double share =
      volume > 0 ? immersion.wet.volume / volume : immersion.draught() / immersion.size();
  return std::clamp(share, 0.0, 1.0);
}

Matrix6 WettedInertia::inertia(const Immersion& immersion) const noexcept {
  AMBIENT_ASSERT(isUnit(immersion.plane.normal));
  AMBIENT_ASSERT(isSymmetric(deep_, 1e-6));
  if (immersion.isDry()) return Matrix6::Zero();
  return immersion.isDeep() ? deep_ : inertiaAt(raised(immersion, PileUp(immersion)));
}

Matrix6 WettedInertia::unraisedInertia(const Immersion& immersion) const noexcept {
  if (immersion.isDry()) return Matrix6::Zero();
  return immersion.isDeep() ? deep_ : inertiaAt(immersion);
}

InertiaGradient WettedInertia::gradient(const Immersion& immersion,
                                        const Twist& twist) const noexcept {
  if (immersion.isDry() || immersion.isDeep()) return {};
  const PileUp pile_up(immersion);
  InertiaGradient gradient = gradientAt(raised(immersion, pile_up), twist);
  if (pile_up.slope == 0 || !(immersion.wet.volume > 0)) return gradient;
  // The rise depends on the lowest point, taken to lie along s below the centre of buoyancy.
  const double by_rise = pile_up.slope * gradient.by_height;
  gradient.by_height += by_rise;
  gradient.by_normal -= by_rise * (immersion.wet.moment / immersion.wet.volume);
  return gradient;
}

}  // namespace ambient
