#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/added_mass_part.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/mass_properties.h"

namespace ambient {

/// Ellipsoid with the second moments of a body, for a first guess of its added mass.
struct EquivalentEllipsoid {
  /// Added mass per unit density, about the origin of the body's mesh: the ellipsoid's, increased
  /// by the volume that the body lacks in the ellipsoid, as a box or a disc does. No coupling about
  /// the centre of volume.
  Matrix6 added_mass = Matrix6::Zero();
  double fullness = 1;  ///< volume of the body over that of the ellipsoid: a cube has 0.89
};

/// Cost: microseconds.
/// @pre the volume is positive.
EquivalentEllipsoid equivalentEllipsoid(const MeshProperties& properties);

/// Estimates the parts of a known added mass for a closed mesh whose flow was not solved, by
/// simplePanels(); all about the mesh's origin.
std::vector<AddedMassPart> estimateParts(TriangleMesh mesh, const Matrix6& added_mass);

}  // namespace ambient
