#pragma once

#include <string>

#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/mesh_defect.h"

namespace ambient {

/// Requirements on a mesh.
struct MeshCheckSettings {
  bool sheet = false;  ///< an open surface of zero thickness; otherwise the boundary of a body
};

/// Checks that a mesh can stand for a body (closed, manifold, outward oriented, enclosing a volume
/// once) or for a sheet (every part open, manifold, one side throughout). Orientation and flat
/// triangles are mended, vertices that no triangle uses and second copies of all triangles left
/// out, closed parts that overlap, touch or lie in each other united (uniteClosedParts()), all with
/// a warning. Cavities are taken out, for the fluid outside does not see them. `name` begins every
/// warning and error. Cost O(T log T) and 256 T solid angles.
/// @throws std::runtime_error in one line with the first of these that is found: no triangles, a
/// coordinate that is not finite, an index out of range, a flat triangle that cannot be mended
/// (height below 1e-7 of its longest edge), two triangles on the same corners, boundary edges
/// (their number and one example), an edge of more than two triangles, a vertex where separate
/// parts touch, and what orientConsistently() and orientShells() refuse.
CheckedMesh checkMesh(const TriangleMesh& mesh, const std::string& name,
                      const MeshCheckSettings& settings = {});

/// True if every part of a sheet has a vertex inside its boundary; the flow around a sheet has its
/// unknowns there. Cost O(T log T).
bool hasVerticesInside(const TriangleMesh& sheet);

/// All defects of a mesh.
struct MeshDiagnosis {
  /// Result of checkMesh() if there are no defects; else the mesh as far as it could be mended.
  /// Triangle numbers of the defects refer to it.
  CheckedMesh checked;
  std::vector<MeshDefect> defects;
};

/// Finds all defects that checkMesh() and requireUsualSize() refuse, instead of the first one only.
/// Defects that only a closed surface can have are not looked for in open ones. Cost: that of
/// checkMesh().
MeshDiagnosis diagnoseMesh(const TriangleMesh& mesh, const std::string& name,
                           const MeshCheckSettings& settings = {});

/// Text of an OBJ file with one object per defect, named after its kind, that has its triangles.
std::string defectsAsObj(const MeshDiagnosis& diagnosis);

}  // namespace ambient
