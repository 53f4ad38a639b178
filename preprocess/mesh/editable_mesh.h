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

}  // namespace ambient
