#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/mass_properties.h"

namespace ambient {

/// The ellipsoid with the second moments of a body, for a first guess of its added mass.
struct EquivalentEllipsoid {
  /// Of the body, per unit density, about the origin of the body's mesh: the ellipsoid's, more for
  /// what of its volume the body lacks, as a box or a disc does. No coupling about the centre of
  /// volume.
  Matrix6 added_mass = Matrix6::Zero();
  double fullness = 1;  ///< volume of the body over that of the ellipsoid: a cube has 0.89
};

/// Cost: microseconds.
/// @pre the volume is positive.
EquivalentEllipsoid equivalentEllipsoid(const MeshProperties& properties);

}  // namespace ambient
