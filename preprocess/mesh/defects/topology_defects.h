#pragma once

#include <vector>

#include "preprocess/mesh/mesh_defect.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {

// Each of these finds all triangles that have a defect, in one entry for each kind; the text has
// their number and one example. Cost O(T log T).

/// No triangles, coordinates that are not finite, indices out of range. Nothing else can be looked
/// for before.
std::vector<MeshDefect> findValueDefects(const TriangleMesh& mesh);

/// Height below kLeastHeight of the longest edge.
std::vector<MeshDefect> findFlatTriangles(const TriangleMesh& mesh);

/// On the same corners as another one.
std::vector<MeshDefect> findDoubleTriangles(const TriangleMesh& mesh);

/// Boundary edges, unless it is a sheet; edges of more than two triangles; vertices at which
/// separate parts touch; closed parts of a sheet.
std::vector<MeshDefect> findTopologyDefects(const TriangleMesh& mesh, const MeshEdges& edges,
                                            bool sheet);

}  // namespace ambient
