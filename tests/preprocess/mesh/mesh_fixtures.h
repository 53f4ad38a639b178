#pragma once

#include <functional>
#include <string>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"
#include "tests/support/refusal_of.h"

namespace ambient {

/// Mesh from literal vertices and triangles; without the box of meshes, which writers of seeds do
/// not link.
inline TriangleMesh meshOf(const std::vector<Eigen::Vector3d>& vertices,
                           const std::vector<Eigen::Vector3i>& triangles) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) mesh.vertices.col(i) = vertices[i];
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) mesh.triangles.col(i) = triangles[i];
  return mesh;
}

/// Tetrahedron with corners at the origin and at 1 on each axis; volume 1/6.
inline TriangleMesh unitTetrahedron() {
  return meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  mesh.vertices.colwise() += by;
  return mesh;
}

inline TriangleMesh scaled(TriangleMesh mesh, double by) {
  mesh.vertices *= by;
  return mesh;
}

inline TriangleMesh rotated(TriangleMesh mesh, const Eigen::Matrix3d& rotation) {
  mesh.vertices = rotation * mesh.vertices;
  return mesh;
}

inline TriangleMesh insideOut(TriangleMesh mesh) {
  mesh.triangles.row(1).swap(mesh.triangles.row(2));
  return mesh;
}

inline TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  return joinMeshes({a, b});
}

inline TriangleMesh withoutTriangle(const TriangleMesh& mesh, Eigen::Index triangle) {
  TriangleMesh result{mesh.vertices, {}};
  result.triangles.resize(3, mesh.triangleCount() - 1);
  result.triangles << mesh.triangles.leftCols(triangle),
      mesh.triangles.rightCols(mesh.triangleCount() - triangle - 1);
  return result;
}

/// Fixed rotation about an oblique axis.
inline Eigen::Matrix3d someRotation() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
}

/// Returns what() of the std::runtime_error thrown by `action`.
inline std::string messageOf(const std::function<void()>& action) {
  const std::string message = test::refusalOf(action);
  return message.empty() ? "no error" : message;
}

}  // namespace ambient
