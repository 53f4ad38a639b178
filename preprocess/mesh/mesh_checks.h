#pragma once

#include <string>
#include <vector>

#include "preprocess/mesh/mesh_defect.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// What a mesh must be.
struct MeshCheckSettings {
  bool sheet = false;  ///< an open surface of zero thickness; otherwise the boundary of a body
};

/// A mesh that has passed a check, possibly with triangles turned round or vertices left out, and
/// what a user should know about that, one line each.
struct CheckedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
  /// Closed parts inside the body, normals into the cavity; the fluid outside does not see them.
  TriangleMesh cavities = {};
};

/// The first part of checkMesh(): flat triangles and second copies mended, unused vertices left
/// out, with warnings.
/// @throws std::runtime_error in one line, for what it says of values and flat triangles.
CheckedMesh mendTriangles(const TriangleMesh& mesh, const std::string& name);

/// A mesh as the surface of a body, oriented if there are no defects.
struct BodyVerdict {
  CheckedMesh checked;
  std::vector<MeshDefect> defects;
};

/// The second part for a body, without uniting anything: all defects. Those that only a closed
/// surface can have are not looked for in others.
/// @throws std::runtime_error in one line that begins with `name`, for a one-sided surface.
BodyVerdict judgeBody(const CheckedMesh& mended, const std::string& name);

/// checkMesh() of a body that unites nothing.
CheckedMesh checkClosedMesh(const TriangleMesh& mesh, const std::string& name);

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
/// parts touch, and what orientConsistently() and orientOutward() refuse.
CheckedMesh checkMesh(const TriangleMesh& mesh, const std::string& name,
                      const MeshCheckSettings& settings = {});

/// Whether every part of a sheet has a vertex inside its boundary: the flow around a sheet is
/// solved for there. Cost O(T log T).
bool hasVerticesInside(const TriangleMesh& sheet);

}  // namespace ambient
