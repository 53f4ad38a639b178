#pragma once

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/mesh_defect.h"

namespace ambient {

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
