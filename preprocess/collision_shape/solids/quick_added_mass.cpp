#include "preprocess/collision_shape/solids/quick_added_mass.h"

#include <algorithm>

#include "preprocess/mesh/mass_properties.h"
#include "preprocess/potential_flow/results/estimated_added_mass.h"

namespace ambient {

Matrix6 quickAddedMass(const Solid& solid) {
  // Volume of the ellipsoid over that of the body up to which the ellipsoid is believed, and from
  // which on the parts are. A box has 1.13.
  constexpr double kCompact = 1.2, kScattered = 1.7;
  if (solid.added_mass) return *solid.added_mass;
  const EquivalentEllipsoid whole = equivalentEllipsoid(computeMassProperties(solid.mesh));
  if (!solid.parts_added_mass) return whole.added_mass;
  const double share =
      std::clamp((1 / whole.fullness - kCompact) / (kScattered - kCompact), 0.0, 1.0);
  return (1 - share) * whole.added_mass + share * *solid.parts_added_mass;
}

}  // namespace ambient
