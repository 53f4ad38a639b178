#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/added_mass_part.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/shape/shape_description.h"

namespace ambient {

/// What is known of a shape without solving the flow around it.
struct KnownShape {
  Matrix6 added_mass;  ///< per unit density, about the shape's origin
  bool is_tabulated;   ///< in place of a closed form
  std::string source;  ///< "closed form", or which tables
};

/// Spheres and ellipsoids by their closed form, boxes, cylinders, capsules and cones from tables as
/// far as these reach; lengths times `scale`. Cost: some microseconds.
std::optional<KnownShape> findKnownShape(const ShapeDescription& shape, double scale);

/// What the parts of a closed mesh have of its added mass, both about the mesh's origin, where no
/// flow was solved, by simplePanels().
std::vector<AddedMassPart> estimateParts(TriangleMesh mesh, const Matrix6& added_mass);

}  // namespace ambient
