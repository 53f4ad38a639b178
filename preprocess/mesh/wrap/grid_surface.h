#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wrap/grid_crossings.h"

namespace ambient {

/// Makes the surface between the nodes of a grid that lie inside a surface, which need not be
/// closed, or near its thin parts, and the other nodes: closed, manifold and
/// outward (Ju, Losasso, Schaefer and Warren, "Dual contouring of Hermite data", 2002). Each cube
/// with nodes of both kinds gets one vertex, where the planes of the mesh at the cube's edges come
/// closest to each other; so sharp edges and corners stay sharp. Each edge between nodes of both
/// kinds gets two triangles. Cost O(nodes + T + A / step^2).
/// @pre coordinates are finite, and the mesh lies inside the grid.
TriangleMesh makeGridSurface(const TriangleMesh& mesh, const CubicGrid& grid);

/// Computes the volume of the union of closed surfaces [m^3], also of those that
/// uniteMeshes() cannot unite, from what 300 by 300 lines across them have in it. Error: about 1e-4
/// of it.
/// @pre each is closed and outward.
double volumeOfUnion(const std::vector<TriangleMesh>& parts);

}  // namespace ambient
