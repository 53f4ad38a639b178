#pragma once

#include <string>

#include "preprocess/mesh/checked_mesh.h"

namespace ambient {

/// Checks a mesh as checkMesh() does, but unites nothing: parts that touch are a defect. Defects
/// that only a closed surface can have are not looked for in others. With defects, the mesh is
/// mended as far as that goes, and not turned.
CheckedMesh checkSurface(const TriangleMesh& mesh, const std::string& name, bool sheet = false);

}  // namespace ambient
