#pragma once

#include <optional>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A surface whose triangles are parts of the flat faces of another, coarser surface.
struct DividedSurface {
  TriangleMesh mesh;
  std::vector<int>
      face;  ///< per triangle: number of the triangle of the coarser surface that it is a part of
};

/// Largest cosine of the angle between the normals at a sharp edge (41 degrees). No regular polygon
/// has this angle, so that rounding does not decide.
constexpr double kSharpCosine = 0.75;

/// Unit normal of a triangle.
Eigen::Vector3d normalOf(const TriangleMesh& mesh, Eigen::Index t);

/// Returns a surface as its own division.
DividedSurface undivided(const TriangleMesh& mesh);

/// Cuts marked edges (by number in MeshEdges::edges) in the middle, and their triangles with them.
/// Neighbours stay matched because they share the marks. Vertices of the surface come first.
DividedSurface cutEdges(const DividedSurface& surface, const MeshEdges& edges,
                        const std::vector<bool>& marks);

/// Cuts the flat faces of a mesh into more triangles where the potential needs them. First the
/// faces are divided into coarse triangles everywhere. Then triangles get thinner towards edges at
/// which the flow is singular, across the edge but not along it, by a factor of 2 per level. Such
/// edges are convex ones with an angle between the normals above 41 degrees; for a sheet creases
/// and the boundary. The first vertices are the mesh's own. Returns at most `max_triangles`
/// triangles, or the mesh itself if it has more. The result depends on the shape and the order of
/// the mesh only, not on its place, size or attitude.
TriangleMesh refineSurface(const TriangleMesh& mesh, bool sheet, int max_triangles);

/// Result of refineSurface(), and a coarser division for extrapolation.
struct SurfaceLevels {
  DividedSurface fine;
  /// Edges twice as long and one level less across sharp edges; none where the faces were not
  /// divided as a whole, or have no sharp edge.
  std::optional<TriangleMesh> coarse;
  /// If there is no coarse one: like the fine one, with one level less across sharp edges.
  std::optional<TriangleMesh> less_thinned;
};
SurfaceLevels refineInLevels(const TriangleMesh& mesh, bool sheet, int max_triangles);

/// Halves the longest edges until there are at least `least_triangles` triangles, of similar size.
/// The surface stays the same. Vertices of the mesh come first.
/// @pre the mesh has a triangle; every edge has one or two.
DividedSurface divideSurface(const TriangleMesh& mesh, int least_triangles);

/// The mesh of divideSurface().
TriangleMesh divideTriangles(const TriangleMesh& mesh, int least_triangles);

/// Halves edges until none is longer than `longest_edge` [m]. The surface stays the same. Vertices
/// of the mesh come first.
/// @pre longest_edge > 0; every edge has one or two triangles.
TriangleMesh divideLongEdges(const TriangleMesh& mesh, double longest_edge);

}  // namespace ambient
