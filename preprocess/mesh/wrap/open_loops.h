#pragma once

#include <vector>

#include "preprocess/mesh/mesh_topology.h"

namespace ambient {

/// A loop of edges that bound an odd number of triangles: the rim of a hole or of a sheet.
struct OpenLoop {
  std::vector<int>
      vertices;  ///< in order, opposite to the orientation of the triangles that the loop bounds
  int triangle = 0;  ///< one of these triangles
};

/// Finds all loops of open edges; each passes a vertex once. Where several loops meet in a vertex,
/// each turns away from its triangle to the nearest open edge. Triangles may have either
/// orientation. Cost O(T log T).
/// @pre indices are in range, coordinates finite.
std::vector<OpenLoop> findOpenLoops(const TriangleMesh& mesh, const MeshEdges& edges);

}  // namespace ambient
