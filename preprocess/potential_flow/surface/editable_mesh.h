#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A manifold mesh whose edges can be flipped and contracted where that leaves its surface in
/// place.
class EditableMesh {
 public:
  /// @param tolerance how far off a plane points may be to lie in it [m]
  EditableMesh(const TriangleMesh& mesh, double tolerance);

  /// Removes vertices inside flat parts, on straight edges between two of them, and on straight
  /// boundaries, one pass over all; returns how many.
  /// @param highest_shape only vertices with a triangle of at most that height over longest edge
  int contractFlatVertices(double highest_shape);

  /// Flips edges between coplanar triangles until opposite angles sum to at most half a turn
  /// (Delaunay 1934; Lawson 1977); returns how many.
  int flipFlatEdges();

  /// True if triangles that are not coplanar, or two edges at which the surface bends or ends, meet
  /// at an angle smaller than that of `sharp_cosine`: the mesh approximates something round.
  bool hasSmoothBends(double sharp_cosine) const;

  /// Returns the present triangles; keeps vertices without a triangle.
  TriangleMesh mesh() const;

 private:
  using Corners = Eigen::Vector3i;

  Eigen::Vector3d point(int v) const { return vertices_.col(v); }
  /// (b - a) x (c - a).
  Eigen::Vector3d crossOf(const Corners& t) const;
  bool isInPlaneOf(const Corners& t, int vertex) const;
  /// Returns the cosine of the angle between the normals of two triangles.
  double cosineBetween(int t, int s) const;
  bool areCoplanar(int t, int s) const;
  /// The triangles at the edge from a to b, at most two.
  std::vector<int> trianglesAt(int a, int b) const;
  std::vector<int> neighboursOf(int v) const;
  /// Returns the neighbours to which a vertex can be moved without changing the surface, folds
  /// aside.
  std::vector<int> contractionTargets(int v) const;
  /// Least height over longest edge of the remaining triangles after a contraction; below 0: not
  /// allowed.
  double qualityAfterContraction(int v, int target) const;
  void contract(int v, int target);
  /// @pre the edge has two triangles.
  bool flip(int a, int b);
  /// Height over longest edge.
  double shapeOf(const Corners& t) const;

  Eigen::Matrix3Xd vertices_;
  std::vector<Corners> triangles_;        ///< -1: removed
  std::vector<std::vector<int>> around_;  ///< per vertex: its triangles
  double tolerance_;
};

}  // namespace ambient
