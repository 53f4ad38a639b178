#pragma once

#include <string>

#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/wrap/mesh_coarsening.h"

namespace ambient {

/// Step of the grid over the diagonal of the bounding box, where no size is given.
constexpr double kDefaultWrapSize = 0.01;

/// A closed surface around anything with triangles: open, overlapping, doubled, crossing itself, in
/// any number of parts, turned whichever way. Holes are filled first (withHolesFilled()), with a
/// warning. Lengths are resolved by cubes of `size` [m] (0: kDefaultWrapSize): gaps narrower than
/// that are closed, what is thinner and encloses nothing gets 1.5 times that thickness, what is
/// enclosed is filled. Elsewhere the surface is that of the
/// triangles, with their sharp edges, to a tenth of the size. It is coarsened to 800 to 4000
/// triangles. The warning compares volume and area with those of the triangles. Axes and place are
/// those of the mesh. Cost O(T + (diagonal / size)^3): half a second by default.
/// @throws std::runtime_error in one line that begins with `name`: no triangles with an area, a
/// coordinate that is not finite, a size that is not positive, too large for the mesh, or so small
/// that the grid would have more than 2e7 nodes; a surface that encloses less than half of what the
/// triangles surround, with both volumes and a size that closes the gaps.
CheckedMesh wrapSurface(const TriangleMesh& mesh, double size, const std::string& name);

/// Nodes of the grid that wraps a mesh with cubes of that size.
double gridNodesAround(const TriangleMesh& mesh, double size);

/// The surface that wrapSurface() finds, coarsened as told and not checked.
/// @pre triangles have an area, and the grid some 1e8 nodes at most.
TriangleMesh wrapped(const TriangleMesh& mesh, double size, const CoarseningSettings& settings);

/// Whether wrapSurface() may make a body of a mesh: coordinates are finite, triangles have areas.
bool canBeWrapped(const TriangleMesh& mesh);

}  // namespace ambient
