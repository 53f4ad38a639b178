#include "preprocess/mesh/graded_grid.h"

#include <cmath>

#include "bullet_ambient/spatial/elementary.h"
#include "bullet_ambient/spatial/pi.h"

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

}  // namespace ambient
