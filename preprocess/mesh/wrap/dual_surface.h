#pragma once

#include "preprocess/mesh/wrap/solid_nodes.h"

namespace ambient {

/// Makes the surface between the solid nodes of a grid and the other nodes: closed, manifold and
/// outward (Ju, Losasso, Schaefer and Warren, "Dual contouring of Hermite data", 2002). Each cube
/// with nodes of both kinds gets one vertex, where the planes of the mesh at the cube's edges come
/// closest to each other; so sharp edges and corners stay sharp. Each edge between nodes of both
/// kinds gets two triangles. Cost O(nodes).
TriangleMesh makeDualSurface(const TriangleMesh& mesh, const CubicGrid& grid,
                             const GridCrossings& crossings, const SolidNodes& nodes);

}  // namespace ambient
