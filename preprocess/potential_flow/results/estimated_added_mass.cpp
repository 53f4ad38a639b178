#include "preprocess/potential_flow/results/estimated_added_mass.h"

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/potential_flow/results/added_mass_parts.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

namespace ambient {

std::vector<AddedMassPart> estimateParts(TriangleMesh mesh, const Matrix6& added_mass) {
  const Vector3 centre = computeMassProperties(mesh).uniform.centre;
  mesh.vertices.colwise() -= centre;
  const Matrix6 about_centre = shiftOrigin(added_mass, centre);
  return placed(joinPanels(simplePanels(mesh, about_centre.diagonal())), 1, centre);
}

}  // namespace ambient
