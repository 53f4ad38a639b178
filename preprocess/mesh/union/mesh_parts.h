#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// The parts of a mesh that hang together by edges of two triangles, each with vertices of its own;
/// those in the same place are one. Cost O(T log T).
std::vector<TriangleMesh> componentsOf(const TriangleMesh& mesh);

/// The closed surfaces that a mesh consists of where some of them share edges, corners or whole
/// triangles, as boxes side by side do: at an edge of more than two triangles those that bound the
/// same wedge of the body belong together. Each is manifold, with vertices of its own. Empty if an
/// edge cannot be divided like that, as where the mesh is open. Cost O(T log T).
std::vector<TriangleMesh> closedParts(const TriangleMesh& mesh);

}  // namespace ambient
