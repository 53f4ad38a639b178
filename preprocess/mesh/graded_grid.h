#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// n + 1 points from -half_length to +half_length [m], denser towards both ends (cosine spacing),
/// symmetric bit for bit.
std::vector<double> cosineSpacing(double half_length, int n);

/// Two triangles per cell of a grid of (rows + 1) x (columns + 1) vertices, `vertex(row, column)`.
/// Diagonals run from the middle of the grid towards its corners (union jack), so that no corner is
/// cut off and the pattern is symmetric for even numbers. Counter-clockwise if columns run to the
/// right and rows upwards.
template <class VertexAt>
void appendGridTriangles(int rows, int columns, VertexAt vertex,
                         std::vector<Eigen::Vector3i>& triangles) {
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const int a = vertex(i, j), b = vertex(i, j + 1);
      const int c = vertex(i + 1, j + 1), d = vertex(i + 1, j);
      if ((2 * i < rows) == (2 * j < columns)) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
      } else {
        triangles.push_back({a, b, d});
        triangles.push_back({b, c, d});
      }
    }
  }
}

/// Makes a mesh of vertices and triangles.
TriangleMesh makeTriangleMesh(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<Eigen::Vector3i>& triangles);

/// Makes a mesh of triangles and the vertices that they use, numbered in the order of first use.
/// @param vertices one per column
TriangleMesh withUsedVertices(const Eigen::Matrix3Xd& vertices,
                              const std::vector<Eigen::Vector3i>& triangles);

}  // namespace ambient
