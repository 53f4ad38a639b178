#pragma once

#include <optional>

#include "preprocess/potential_flow/edge_cuts.h"

namespace ambient {

/// The same flat faces cut into more triangles where the potential needs them: coarse triangles
/// everywhere, then, towards edges the flow is singular at (convex ones with an angle between the
/// normals above 41 degrees; for a sheet creases and the boundary), triangles that are thinned
/// across the edge but not along it, a factor of 2 per level. The first vertices are the mesh's
/// own. At most `max_triangles` result, or the mesh itself when it has more. Depends on the shape
/// and the order of the mesh only, not on its place, size or attitude.
TriangleMesh refineSurface(const TriangleMesh& mesh, bool sheet, int max_triangles);

/// refineSurface() with what extrapolation needs.
struct SurfaceLevels {
  DividedSurface fine;
  /// Edges twice as long and one level less across sharp edges; none where the faces were not
  /// divided as a whole, or have no sharp edge.
  std::optional<TriangleMesh> coarse;
  /// In place of a coarse one: as the fine one, but a level less across sharp edges.
  std::optional<TriangleMesh> less_thinned;
};
SurfaceLevels refineInLevels(const TriangleMesh& mesh, bool sheet, int max_triangles);

/// The same surface, its longest edges halved again and again until there are at least so many
/// triangles, of similar size. Vertices of the mesh come first.
/// @pre the mesh has a triangle; every edge has one or two.
TriangleMesh divideTriangles(const TriangleMesh& mesh, int least_triangles);

/// The same surface, edges halved until none is longer than that [m]. Vertices of the mesh come
/// first.
/// @pre longest_edge > 0; every edge has one or two triangles.
TriangleMesh divideLongEdges(const TriangleMesh& mesh, double longest_edge);

/// The same surface, thinned towards the first `vertex_count` vertices, which lie on narrow rounded
/// edges: edges with one end there are halved, up to four times, while at most `max_triangles`
/// result. Vertices of the mesh come first.
TriangleMesh refineTowardsFirst(const TriangleMesh& mesh, Eigen::Index vertex_count,
                                int max_triangles);

}  // namespace ambient
