#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A mesh whose vertices closer than `tolerance` [m] are one (chains too), in place of the first of
/// them, without the triangles that lost a corner by it. Order is kept. Cost O(V + T).
/// @pre coordinates are finite, tolerance >= 0; 0 joins equal vertices only.
TriangleMesh weldVertices(const TriangleMesh& mesh, double tolerance);

}  // namespace ambient
