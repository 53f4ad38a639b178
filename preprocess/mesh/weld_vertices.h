#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Joins vertices closer than `tolerance` [m], also along chains, at the place of the first of
/// them, and removes triangles that lose a corner. Order is kept. Cost O(V log V + T)
/// plus the pairs that are close along one direction.
/// @pre coordinates are finite, tolerance >= 0; 0 joins equal vertices only.
TriangleMesh weldVertices(const TriangleMesh& mesh, double tolerance);

}  // namespace ambient
