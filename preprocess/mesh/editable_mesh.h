#pragma once

#include <Eigen/Core>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A mesh whose edges can be contracted, with the triangles at each vertex.
struct EditableMesh {
  using Corners = Eigen::Vector3i;

  explicit EditableMesh(const TriangleMesh& mesh);

  Eigen::Vector3d point(int v) const { return vertices.col(v); }
  /// (b - a) x (c - a).
  Eigen::Vector3d crossOf(const Corners& t) const {
    return (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
  }
  /// Height over longest edge; 0 of a point.
  double shapeOf(const Corners& t) const;
  std::vector<int> trianglesAt(int a, int b) const;
  /// In ascending order.
  std::vector<int> neighboursOf(int v) const;
  /// Number of vertices that are neighbours of both.
  std::size_t commonNeighbours(int a, int b) const;
  /// Takes v out: its triangles get the target, its neighbour, in its place, those at the edge
  /// between both go. Returns how many these are.
  int contract(int v, int target);
  std::vector<Corners> trianglesLeft() const;

  Eigen::Matrix3Xd vertices;             ///< keeps those without a triangle [m]
  std::vector<Corners> triangles;        ///< -1: removed
  std::vector<std::vector<int>> around;  ///< per vertex: its triangles
};

/// Whether v is a corner of t.
inline bool holds(const Eigen::Vector3i& t, int v) { return t[0] == v || t[1] == v || t[2] == v; }

/// Limits of coarsening.
struct CoarseningSettings {
  int least_faces = 0;  ///< coarsening stops at this number of triangles
  int most_faces = 0;   ///< coarsening goes on to this number, whatever the error
  double tolerance =
      0;  ///< between both numbers: limit of the rms distance from the original planes [m]
};

/// Reduces the triangles of a closed mesh with about the same surface: contracts edges, first those
/// that move the surface least (Garland and Heckbert, "Surface simplification using quadric error
/// metrics", 1997), unless a triangle would turn or become a sliver, or the surface would change
/// its topology. Flat sides and sharp edges stay in place. Cost O(T log T).
/// @pre closed and manifold.
TriangleMesh coarsened(const TriangleMesh& mesh, const CoarseningSettings& settings);

}  // namespace ambient
