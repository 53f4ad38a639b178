#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// All parts as one mesh, one after the other; nothing is welded.
TriangleMesh joinMeshes(const std::vector<TriangleMesh>& parts);

}  // namespace ambient
