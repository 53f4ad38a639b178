#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Estimates the parts of a known added mass for a closed mesh whose flow was not solved, by
/// simplePanels(); all about the mesh's origin.
std::vector<AddedMassPart> estimateParts(TriangleMesh mesh, const Matrix6& added_mass);

}  // namespace ambient
