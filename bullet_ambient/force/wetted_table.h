#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/fluid_body/packed_hull.h"
#include "bullet_ambient/force/wetted_parts.h"

namespace ambient {

/// Added mass at the surface by parts, and what a table says that they lack; docs/theory.md eq.
/// (61a).
class WettedTable final : public WettedParts {
 public:
  /// @pre the body has a waterline table; `hull` is that of the body
  WettedTable(std::shared_ptr<const FluidBody> body, std::shared_ptr<const PackedParts> parts,
              std::shared_ptr<const PackedHull> hull);

 private:
  Matrix6 inertiaAt(const Immersion& raised) const noexcept override;
  /// The correction as if it depended on the depth of the waterplane alone.
  InertiaGradient gradientAt(const Immersion& raised, const Twist& twist) const noexcept override;

  /// Of four nodes in turn.
  struct Weights {
    int first;
    double of_value[4], of_slope[4];
  };
  /// A body that has just touched the water, less deep than the first node of its table: the added
  /// mass is that at the node, less with the square of the depth, as of a wedge.
  struct Touch {
    Immersion at;      ///< at the first node, or where the body is if that is deeper
    double share = 1;  ///< of the added mass there
    double slope = 0;  ///< of the share by the height of the plane [1/m]; 0: it has its own nodes
  };
  Touch touchAt(const Immersion& at) const noexcept;
  Matrix6 inertiaOf(const Touch& touch) const noexcept;
  Weights weightsAt(double immersion) const noexcept;
  Matrix6 interpolate(const Vector3& normal, int first, const double (&weights)[4]) const noexcept;

  std::shared_ptr<const FluidBody> body_;
  std::shared_ptr<const PackedHull> hull_;
  OctahedralLattice lattice_;
  std::vector<double> nodes_;  ///< immersions of the table, and where it ends
};

}  // namespace ambient
