#pragma once

#include <optional>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Remeshes the body of a closed mesh with about `triangles` triangles, nearly as long as wide,
/// whatever the triangles of the mesh are; keeps sharp edges and volume. Polygons of many short
/// sides, between long strips, get fewer sides. None if that would change the area by more than
/// half a per cent or the volume (before it is restored) by more than a quarter, or needs a grid of
/// more than 5e6 nodes: thin parts would be lost. Cost: some 0.2 s.
/// @pre closed, manifold and outward.
std::optional<TriangleMesh> compactSurface(const TriangleMesh& mesh, int triangles);

/// Coarsens a closed mesh to about `triangles` triangles, see coarsened(); keeps its volume and its
/// centre of volume. None if so few cannot be reached, or would change area or volume (before it is
/// restored) by more than 2 %: the body has details that they do not show. Cost O(T log T).
/// @pre closed, manifold and outward.
std::optional<TriangleMesh> inFewerTriangles(const TriangleMesh& mesh, int triangles);

}  // namespace ambient
