#pragma once

#include <vector>

#include "preprocess/mesh/mesh_topology.h"

namespace ambient {

/// A loop of edges that bound an odd number of triangles: the rim of a hole or of a sheet.
struct OpenLoop {
  std::vector<int> vertices;  ///< in order, turning against the triangles that it bounds
  int triangle = 0;           ///< one of these
};

/// All loops of open edges, each through a vertex once. Where several loops meet in a vertex, each
/// turns away from its triangle to the nearest open edge. Triangles may be turned either way. Cost
/// O(T log T).
/// @pre indices are in range, coordinates finite.
std::vector<OpenLoop> findOpenLoops(const TriangleMesh& mesh, const MeshEdges& edges);

}  // namespace ambient
