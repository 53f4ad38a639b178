#pragma once

#include <string>
#include <vector>

#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/mesh_defect.h"

namespace ambient {

/// Mends flat triangles and second copies and leaves unused vertices out, with warnings: the first
/// part of checkMesh().
/// @throws std::runtime_error in one line: no triangles, a coordinate that is not finite, an index
/// out of range, a flat triangle that cannot be mended.
CheckedMesh mendTriangles(const TriangleMesh& mesh, const std::string& name);

/// Result of judgeBody(): the mesh, oriented if there are no defects, and the defects.
struct BodyVerdict {
  CheckedMesh checked;
  std::vector<MeshDefect> defects;
};

/// Finds all defects of a body without uniting anything: the second part of checkMesh(). Those
/// that only a closed surface can have are not looked for in others.
/// @throws std::runtime_error in one line that begins with `name`, for a one-sided surface.
BodyVerdict judgeBody(const CheckedMesh& mended, const std::string& name);

/// Checks a body as checkMesh() does, but unites nothing.
/// @throws std::runtime_error with the first defect
CheckedMesh checkClosedMesh(const TriangleMesh& mesh, const std::string& name);

}  // namespace ambient
