#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Returns the parts of a mesh that are connected by edges of two triangles, each with vertices of
/// its own; equal vertices are joined. Cost O(T log T).
std::vector<TriangleMesh> componentsOf(const TriangleMesh& mesh);

/// Divides a mesh into closed surfaces, where some of them share edges, corners or whole triangles,
/// as boxes side by side do. At an edge of more than two triangles, those that bound the same wedge
/// of the body belong together. Each surface is manifold, with vertices of its own. Empty if an
/// edge cannot be divided so, for example where the mesh is open. Cost O(T log T).
std::vector<TriangleMesh> closedParts(const TriangleMesh& mesh);

}  // namespace ambient
