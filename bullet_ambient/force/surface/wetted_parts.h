#pragma once

#include <memory>
#include <vector>

#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"

namespace ambient {

/// Added mass at the surface by the parts of the added mass in unbounded fluid, weighted by their
/// depth; docs/theory.md eq. (60), (61).
class WettedParts : public WettedInertia {
 public:
  WettedParts(const FluidBody& body, std::shared_ptr<const AddedMassParts> parts);

 protected:
  Matrix6 inertiaAt(const Immersion& raised) const noexcept override;
  InertiaGradient gradientAt(const Immersion& raised, const Twist& twist) const noexcept override;

 private:
  std::shared_ptr<const AddedMassParts> parts_;
  Matrix6 defect_;  ///< added mass minus the sum of the parts
  double volume_;
};

/// Added mass at the surface: WettedParts plus the correction of a waterline table; docs/theory.md
/// eq. (61a).
class WettedTable final : public WettedParts {
 public:
  /// @pre the body has a waterline table; `parts` and `hull` belong to the body
  WettedTable(std::shared_ptr<const FluidBody> body, std::shared_ptr<const AddedMassParts> parts,
              std::shared_ptr<const PackedHull> hull);

 private:
  Matrix6 inertiaAt(const Immersion& raised) const noexcept override;
  /// Gradient; the correction counts as a function of the depth of the waterplane's centroid only.
  InertiaGradient gradientAt(const Immersion& raised, const Twist& twist) const noexcept override;

  /// Cubic interpolation: index of the first of four nodes, weights of value and slope.
  struct Weights {
    int first;
    double of_value[4], of_slope[4];
  };
  /// State of a body whose immersion is below the first node of the table. Its added mass is that
  /// at the first node times a factor, which grows with the square of the depth, as for a wedge.
  struct Touch {
    Immersion at;       ///< immersion at the first node, or the body's own if that is deeper
    double factor = 1;  ///< factor on the added mass at `at`
    double slope = 0;   ///< d factor / d height of the plane [1/m]; 0: deeper than the first node
  };
  Touch touchAt(const Immersion& at) const noexcept;
  /// Share of the wet volume that is between the sides of the pool; 1 where it has none.
  double shareInPool(const Immersion& at) const noexcept;
  Matrix6 inertiaOf(const Touch& touch) const noexcept;
  Weights weightsAt(double immersion) const noexcept;
  Matrix6 interpolate(const Vector3& normal, int first, const double (&weights)[4]) const noexcept;

  std::shared_ptr<const FluidBody> body_;
  std::shared_ptr<const PackedHull> hull_;
  OctahedralLattice lattice_;
  std::vector<double> nodes_;  ///< immersions of the table, then kDeep
};

/// Makes the added mass of a body at the surface of the water. Sphere: WettedSphere. With parts of
/// the added mass: WettedParts, eq. (60), or WettedTable, eq. (61a). Without parts: the added mass
/// times the wet share of the volume. Cost: O(parts).
std::shared_ptr<const WettedInertia> makeWettedInertia(
    const std::shared_ptr<const FluidBody>& body);

}  // namespace ambient
