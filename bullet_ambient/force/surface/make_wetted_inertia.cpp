#include "bullet_ambient/force/surface/make_wetted_inertia.h"

#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/surface/wetted_parts.h"
#include "bullet_ambient/force/surface/wetted_sphere.h"

namespace ambient {
namespace {

/// Added mass times the wet share of the volume: approximation for a body without parts.
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

std::shared_ptr<const WettedInertia> makeWettedInertia(
    const std::shared_ptr<const FluidBody>& body) {
  const LoadTables tables(body);
  return tables.wettedInertia([&]() -> std::shared_ptr<const WettedInertia> {
    if (body->sphere_radius > 0) return std::make_shared<WettedSphere>(*body);
    if (body->added_mass_parts.empty()) return std::make_shared<WettedShare>(*body);
    const std::shared_ptr<const AddedMassParts> parts{body, &body->added_mass_parts};
    if (!body->waterline.empty()) return std::make_shared<WettedTable>(body, parts, tables.hull());
    return std::make_shared<WettedParts>(*body, parts);
  });
}

}  // namespace ambient
