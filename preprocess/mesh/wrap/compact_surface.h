#pragma once

#include <optional>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// The body of a closed mesh in about so many triangles nearly as long as wide, however the mesh
/// was cut, with its sharp edges and its volume: polygons of many short sides, between long strips,
/// become such of fewer sides. None if that would change the area by more than half a per cent, the
/// volume, before it is mended, by more than a quarter, or take a grid of more than 5e6 nodes: thin
/// parts would be lost. Cost some 0.2 s.
/// @pre closed, manifold and outward.
std::optional<TriangleMesh> compactSurface(const TriangleMesh& mesh, int triangles);

/// The body of a closed mesh in about so many of its own triangles, coarsened(), with its volume
/// and its centre of volume. None if that many cannot be reached, or change area or volume, before
/// it is mended, by more than 2 %: the body has details that they do not show. Cost O(T log T).
/// @pre closed, manifold and outward.
std::optional<TriangleMesh> inFewerTriangles(const TriangleMesh& mesh, int triangles);

}  // namespace ambient
