#include "preprocess/mesh/graded_grid.h"

#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {

std::vector<double> cosineSpacing(double half_length, int n) {
  std::vector<double> points(n + 1, 0.0);
  for (int i = 0; 2 * i < n; ++i) {
    points[n - i] = half_length * portable::cos(kPi * i / n);
    points[i] = -points[n - i];
  }
  return points;
}

TriangleMesh makeTriangleMesh(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<Eigen::Vector3i>& triangles) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) mesh.vertices.col(i) = vertices[i];
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) mesh.triangles.col(i) = triangles[i];
  return mesh;
}

TriangleMesh withUsedVertices(const Eigen::Matrix3Xd& vertices,
                              const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<int> number(static_cast<std::size_t>(vertices.cols()), -1);
  std::vector<Eigen::Vector3d> used;
  std::vector<Eigen::Vector3i> renumbered = triangles;
  for (Eigen::Vector3i& triangle : renumbered) {
    for (int& v : triangle) {
      int& own = number[static_cast<std::size_t>(v)];
      if (own < 0) {
        own = static_cast<int>(used.size());
        used.emplace_back(vertices.col(v));
      }
      v = own;
    }
  }
  return makeTriangleMesh(used, renumbered);
}

}  // namespace ambient
