#pragma once

#include <memory>

#include "bullet_ambient/fluid_body/packed_parts.h"
#include "bullet_ambient/force/wetted_inertia.h"

namespace ambient {

/// Added mass at the surface from the potentials of the body alone in the fluid, weighted by their
/// depth; docs/theory.md eq. (60), (61).
class WettedParts : public WettedInertia {
 public:
  WettedParts(const FluidBody& body, std::shared_ptr<const PackedParts> parts);

 protected:
  Matrix6 inertiaAt(const Immersion& raised) const noexcept override;
  InertiaGradient gradientAt(const Immersion& raised, const Twist& twist) const noexcept override;

 private:
  std::shared_ptr<const PackedParts> parts_;
  Matrix6 defect_;  ///< what the parts lack of the added mass
  double volume_;
};

}  // namespace ambient
