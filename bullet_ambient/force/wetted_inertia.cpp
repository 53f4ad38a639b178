#include "bullet_ambient/force/wetted_inertia.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/force/load_tables.h"
#include "bullet_ambient/force/wetted_parts.h"
#include "bullet_ambient/force/wetted_sphere.h"

namespace ambient {
namespace {

/// Of a body that enters the water: docs/theory.md eq. (65).
Immersion raised(const Immersion& immersion) {
  constexpr double kPileUp = 0.4;
  const double size = immersion.size();
  if (!(immersion.draught() < size)) return immersion;
  const double dry = 1 - immersion.draught() / size;
  const double dry4 = dry * dry * dry * dry;
  Immersion result = immersion;
  result.plane.height += kPileUp * dry4 * dry4 * immersion.draught();
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
  return immersion.isDeep() ? deep_ : inertiaAt(raised(immersion));
}

InertiaGradient WettedInertia::gradient(const Immersion& immersion,
                                        const Twist& twist) const noexcept {
  if (immersion.isDry() || immersion.isDeep()) return {};
  return gradientAt(raised(immersion), twist);
}

std::shared_ptr<const WettedInertia> makeWettedInertia(const std::shared_ptr<const FluidBody>& body,
                                                       LoadTables& tables) {
  if (body->sphere_radius > 0) return std::make_shared<WettedSphere>(*body);
  if (body->added_mass_parts.empty()) return std::make_shared<WettedShare>(*body);
  return std::make_shared<WettedParts>(*body, tables.addedMassParts(body));
}

}  // namespace ambient
