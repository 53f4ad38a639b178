#pragma once

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/mesh_defect.h"

namespace ambient {

/// All that is wrong with a mesh.
struct MeshDiagnosis {
  /// Result of checkMesh() if there are no defects; else the mesh as far as it could be mended.
  /// Triangle numbers of the defects refer to it.
  CheckedMesh checked;
  std::vector<MeshDefect> defects;
};

/// checkMesh() and requireUsualSize() that look for all defects in place of refusing the first one.
/// Those that only a closed surface can have are not looked for in others. Cost as checkMesh().
MeshDiagnosis diagnoseMesh(const TriangleMesh& mesh, const std::string& name,
                           const MeshCheckSettings& settings = {});

/// The triangles of each defect as an object of an OBJ file, named after its kind.
std::string defectsAsObj(const MeshDiagnosis& diagnosis);

}  // namespace ambient
