#pragma once

#include <optional>
#include <string>

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/editable_mesh.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Default step of the grid, over the diagonal of the bounding box [1].
constexpr double kDefaultWrapSize = 0.01;

/// Makes a closed surface around any triangles: open, overlapping, doubled, crossing, in any number
/// of parts, of any orientation. First fills holes, with a warning. The
/// resolution is `size` [m] (0: kDefaultWrapSize): narrower gaps are closed, thinner open parts
/// get 1.5 times that thickness, enclosed space is filled. Elsewhere the surface is that of the
/// triangles, with their sharp edges, to a tenth of the size. It is coarsened to 800 to 4000
/// triangles. The warning compares volume and area with those of the triangles. Axes and place are
/// those of the mesh. Cost O(T + (diagonal / size)^3): half a second by default.
/// @throws std::runtime_error in one line that begins with `name`: no triangles with an area, a
/// coordinate that is not finite, a size that is not positive, too large for the mesh, or so small
/// that the grid would have more than 2e7 nodes; a surface that encloses less than half of what the
/// triangles surround, with both volumes and a size that closes the gaps; or more than 1.25 times
/// their convex hull, unless that is thinner than the default size.
CheckedMesh wrapSurface(const TriangleMesh& mesh, double size, const std::string& name);

/// Makes the closed surface of a body from any mesh: the result of checkMesh(); a mesh with
/// defects gets its holes filled, with a warning that names them; what has defects then is wrapped
/// at the default size instead, with one that names the defect and gives volume and area before and
/// after. Every way from a mesh to a body leads through here.
/// @param strict true: nothing is wrapped
/// @param unit a length of 1 in metres, for the numbers of that warning
/// @throws std::runtime_error in one line that begins with `name`, with the first defect: of any
/// mesh that has one, if `strict`; else of one without triangles or with values out of
/// range, of a sheet (a closed surface without volume, or an open one with a loop of open edges
/// that would take more than 0.9 of its area), and of what wrapSurface() refuses.
CheckedMesh makeBodyMesh(const TriangleMesh& mesh, const std::string& name, bool strict,
                         double unit = 1);

/// Number of nodes of the grid that wrapSurface() uses for a mesh and a size [m].
double gridNodesAround(const TriangleMesh& mesh, double size);

/// Makes the surface of wrapSurface(), coarsened by `settings` and not checked.
/// @pre triangles have an area, and the grid some 1e8 nodes at most.
TriangleMesh wrapped(const TriangleMesh& mesh, double size, const CoarseningSettings& settings);

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
