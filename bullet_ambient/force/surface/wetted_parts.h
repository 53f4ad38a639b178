#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/packed/packed_parts.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"

namespace ambient {

/// Added mass at the surface by the parts of the added mass in unbounded fluid, weighted by their
/// depth; docs/theory.md eq. (60), (61).
class WettedParts : public WettedInertia {
 public:
  WettedParts(const FluidBody& body, std::shared_ptr<const PackedParts> parts);

 protected:
  Matrix6 inertiaAt(const Immersion& raised) const noexcept override;
  InertiaGradient gradientAt(const Immersion& raised, const Twist& twist) const noexcept override;

 private:
  std::shared_ptr<const PackedParts> parts_;
  Matrix6 defect_;  ///< added mass minus the sum of the parts
  double volume_;
};

}  // namespace ambient
