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

/// Box of half sizes (1, 1, height) without its upper side.
inline TriangleMesh openBox(TriangleMesh box, double height) {
  for (Eigen::Index t = box.triangleCount() - 1; t >= 0; --t)
    if (box.barycentre(t).z() > height - 1e-9) box = withoutTriangle(box, t);
  return box;
}

/// The triangles of a cube of half size 1, whose sides are drawn together by a part of it, so that
/// gaps are between them. No two triangles share vertices.
inline TriangleMesh cubeOfPlates(const TriangleMesh& cube, double gap) {
  TriangleMesh plates;
  plates.vertices.resize(3, 36);
  plates.triangles.resize(3, 12);
  for (int i = 0; i < 36; ++i) {
    plates.triangles(i % 3, i / 3) = i;
    const Eigen::Vector3d corner = cube.corner(i / 3, i % 3);
    plates.vertices.col(i) = corner - gap * (corner - cube.twiceArea(i / 3).normalized());
  }
  return plates;
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
