#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/force/wetted_parts.h"

namespace ambient {

/// Added mass at the surface by parts, and what a table says that they lack; docs/theory.md eq.
/// (61a).
class WettedTable final : public WettedParts {
 public:
  /// @pre the body has a waterline table
  WettedTable(std::shared_ptr<const FluidBody> body, std::shared_ptr<const PackedParts> parts);

 private:
  Matrix6 inertiaAt(const Immersion& raised) const noexcept override;
  /// The correction as if it depended on the depth of the waterplane alone.
  InertiaGradient gradientAt(const Immersion& raised, const Twist& twist) const noexcept override;

  /// Of four nodes in turn.
  struct Weights {
    int first;
    double of_value[4], of_slope[4];
  };
  Weights weightsAt(double immersion) const noexcept;
  Matrix6 interpolate(const Vector3& normal, int first, const double (&weights)[4]) const noexcept;

  std::shared_ptr<const FluidBody> body_;
  OctahedralLattice lattice_;
  std::vector<double> nodes_;  ///< immersions of the table, and where it ends
};

}  // namespace ambient
