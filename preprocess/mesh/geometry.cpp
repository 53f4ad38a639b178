#include "preprocess/mesh/geometry.h"

#include <algorithm>

namespace ambient {

using Eigen::Index;
using Eigen::Vector3d;

TriangleCorners cornersOf(const TriangleMesh& mesh, Index t) {
  TriangleCorners corners;
  corners << mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2);
  return corners;
}

Vector3d normalOf(const TriangleCorners& triangle) {
  return (triangle.col(1) - triangle.col(0))
      .cross(triangle.col(2) - triangle.col(0))
      .stableNormalized();
}

double areaOf(const TriangleMesh& mesh, Index t) { return mesh.twiceArea(t).norm() / 2; }

double areaOf(const TriangleMesh& mesh) {
  double area = 0;
  for (Index t = 0; t < mesh.triangleCount(); ++t) area += areaOf(mesh, t);
  return area;
}

double tetrahedronVolume(const TriangleMesh& mesh, Index t, const Vector3d& point) {
  const Vector3d a = mesh.corner(t, 0) - point, b = mesh.corner(t, 1) - point,
                 c = mesh.corner(t, 2) - point;
  return a.dot(b.cross(c)) / 6;
}

double tetrahedraVolume(const TriangleMesh& mesh, const Vector3d& point) {
  double volume = 0;
  for (Index t = 0; t < mesh.triangleCount(); ++t) volume += tetrahedronVolume(mesh, t, point);
  return volume;
}

Vector3d nearestOnSegment(const Vector3d& x, const Vector3d& a, const Vector3d& b) {
  const double along = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return a + along * (b - a);
}

Vector3d nearestPoint(const TriangleCorners& triangle, const Vector3d& x) {
  const Vector3d a = triangle.col(0), b = triangle.col(1), c = triangle.col(2);
  const Vector3d normal = (b - a).cross(c - a).normalized();
  const auto isInside = [&](const Vector3d& from, const Vector3d& to) {
    return (to - from).cross(x - from).dot(normal) >= 0;
  };
  if (isInside(a, b) && isInside(b, c) && isInside(c, a)) return x - (x - a).dot(normal) * normal;
  Vector3d nearest = nearestOnSegment(x, a, b);
  for (const Vector3d& other : {nearestOnSegment(x, b, c), nearestOnSegment(x, c, a)})
    if ((other - x).squaredNorm() < (nearest - x).squaredNorm()) nearest = other;
  return nearest;
}

Eigen::AlignedBox3d boundsOf(const TriangleMesh& mesh, Index t) {
  const TriangleCorners corners = cornersOf(mesh, t);
  return {corners.rowwise().minCoeff(), corners.rowwise().maxCoeff()};
}

bool areNear(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b, double gap) {
  return ((a.min() - b.max()).array() <= gap).all() && ((b.min() - a.max()).array() <= gap).all();
}

}  // namespace ambient
