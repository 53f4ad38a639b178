#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Joins parts to one mesh, one after the other; welds nothing.
TriangleMesh joinMeshes(const std::vector<TriangleMesh>& parts);

}  // namespace ambient
