#pragma once

#include <vector>

#include "preprocess/mesh/mesh_topology.h"

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

}  // namespace ambient
