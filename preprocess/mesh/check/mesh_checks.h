#pragma once

#include <string>
#include <vector>

#include "preprocess/mesh/checked_mesh.h"

namespace ambient {

/// Checks whether a mesh can stand for a body (closed, manifold, outward oriented, enclosing a
/// volume once) or for a `sheet` (every part open, manifold, one side throughout). Orientation and
/// flat triangles are mended, vertices that no triangle uses and second copies of all triangles
/// left out, closed parts that overlap, touch or lie in each other united (uniteClosedParts()), all
/// with a warning. Cavities are taken out, for the fluid outside does not see them. `name` begins
/// every warning. Cost O(T log T) and 256 T solid angles.
///
/// Defects, in this order: no triangles, a coordinate that is not finite, an index out of range
/// (then nothing else is looked for), a flat triangle that cannot be mended (height below 1e-7 of
/// its longest edge), two triangles on the same corners, boundary edges (their number and one
/// example), an edge of more than two triangles, a vertex where separate parts touch; without any
/// of these, what orientConsistently() and orientShells() find.
CheckedMesh checkMesh(const TriangleMesh& mesh, const std::string& name, bool sheet = false);

/// True if every part of a sheet has a vertex inside its boundary; the flow around a sheet has its
/// unknowns there. Cost O(T log T).
bool hasVerticesInside(const TriangleMesh& sheet);

/// Finds where the surface of a checked mesh crosses itself or another part, if it is open:
/// checkMesh() finds the crossings of closed ones.
std::vector<MeshDefect> findCrossings(const TriangleMesh& mesh);

/// Text of an OBJ file with one object per defect, named after its kind, that has its triangles.
std::string defectsAsObj(const CheckedMesh& checked);

}  // namespace ambient
