#pragma once

#include <vector>

#include "preprocess/mesh/mesh_topology.h"

namespace ambient {

/// A surface and a finer one of the same flat faces.
struct DividedSurface {
  TriangleMesh mesh;
  std::vector<int> face;  ///< per triangle: the triangle of the first surface that it is part of
};

/// Cosine of the angle between the normals at an edge from which on the edge is sharp; no regular
/// polygon turns by it, so that rounding does not decide.
constexpr double kSharpCosine = 0.75;

/// Unit normal of a triangle.
Eigen::Vector3d normalOf(const TriangleMesh& mesh, Eigen::Index t);

/// The surface as its own division.
DividedSurface undivided(const TriangleMesh& mesh);

/// Cuts triangles along marked edges (by number in MeshEdges::edges) in the middle; neighbours stay
/// matched because they share the marks. Vertices of the surface come first.
DividedSurface cutEdges(const DividedSurface& surface, const MeshEdges& edges,
                        const std::vector<bool>& marks);

}  // namespace ambient
