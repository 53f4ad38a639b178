#include "bullet_ambient/force/wetted_inertia.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/force/load_tables.h"
#include "bullet_ambient/force/wetted_parts.h"
#include "bullet_ambient/force/wetted_sphere.h"
#include "bullet_ambient/force/wetted_table.h"

namespace ambient {
namespace {

/// By how much an entering body raises the water, docs/theory.md eq. (65), and its derivative by
/// the height of the plane.
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

/// The added mass times the share of the volume: all that is known of a body without parts.
class WettedShare final : public WettedInertia {
 public:
  explicit WettedShare(const FluidBody& body)
      : WettedInertia(body.added_mass), volume_(body.volume) {}

 private:
  Matrix6 inertiaAt(const Immersion& at) const noexcept override {
    return wetShare(at, volume_) * deep();
  }
  InertiaGradient gradientAt(const Immersion& at, const Twist& twist) const noexcept override {
    if (!(volume_ > 0)) return {};
    const Vector6 x = twist.vector();
    const Waterplane& plane = at.wet.waterplane;
    const double by_height = 0.5 * x.dot(deep() * x) * plane.area / volume_;
    return {by_height, -by_height * plane.centroid};
  }

  double volume_;
};

}  // namespace

double wetShare(const Immersion& immersion, double volume) noexcept {
  const double share =
      volume > 0 ? immersion.wet.volume / volume : immersion.draught() / immersion.size();
  return std::clamp(share, 0.0, 1.0);
}

Matrix6 WettedInertia::inertia(const Immersion& immersion) const noexcept {
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
  // The lowest point, on which the rise depends, is below the centre of buoyancy or not far off.
  const double by_rise = pile_up.slope * gradient.by_height;
  gradient.by_height += by_rise;
  gradient.by_normal -= by_rise * (immersion.wet.moment / immersion.wet.volume);
  return gradient;
}

std::shared_ptr<const WettedInertia> makeWettedInertia(const std::shared_ptr<const FluidBody>& body,
                                                       LoadTables& tables) {
  return tables.wettedInertia(body, [&]() -> std::shared_ptr<const WettedInertia> {
    if (body->sphere_radius > 0) return std::make_shared<WettedSphere>(*body);
    if (body->added_mass_parts.empty()) return std::make_shared<WettedShare>(*body);
    if (!body->waterline.empty())
      return std::make_shared<WettedTable>(body, tables.addedMassParts(body), tables.hull(body));
    return std::make_shared<WettedParts>(*body, tables.addedMassParts(body));
  });
}

}  // namespace ambient
