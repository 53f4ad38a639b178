#pragma once

#include "preprocess/mesh/wrap/solid_nodes.h"

namespace ambient {

/// The surface between the solid nodes of a grid and the others, closed, manifold and outward: one
/// vertex in each cube between nodes of both kinds, where the planes of the surface that its edges
/// meet come closest to each other, so that sharp edges and corners stay sharp (Ju, Losasso,
/// Schaefer and Warren, "Dual contouring of Hermite data", 2002); two triangles around each edge
/// between nodes of both kinds. Cost O(nodes).
TriangleMesh makeDualSurface(const TriangleMesh& mesh, const CubicGrid& grid,
                             const GridCrossings& crossings, const SolidNodes& nodes);

}  // namespace ambient
