#include "preprocess/mesh/defects/triangle_contact.h"

#include <algorithm>
#include <cmath>

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

double sixfoldVolume(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

Vector3d nearestOnSegment(const Vector3d& x, const Vector3d& a, const Vector3d& b) {
  const double along = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return a + along * (b - a);
}

double distanceToSegment(const Vector3d& x, const Vector3d& a, const Vector3d& b) {
  return (x - nearestOnSegment(x, a, b)).norm();
}

}  // namespace

bool crossesTriangle(const Vector3d& p, const Vector3d& q, const TriangleMesh& mesh, Index t) {
  const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
  if (sixfoldVolume(a, b, c, p) * sixfoldVolume(a, b, c, q) > 0) return false;
  const double u = sixfoldVolume(p, q, a, b), v = sixfoldVolume(p, q, b, c),
               w = sixfoldVolume(p, q, c, a);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

double distanceToTriangle(const Vector3d& x, const TriangleMesh& mesh, Index t) {
  const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
  const Vector3d normal = (b - a).cross(c - a).normalized();
  const auto isInside = [&](const Vector3d& from, const Vector3d& to) {
    return (to - from).cross(x - from).dot(normal) >= 0;
  };
  if (isInside(a, b) && isInside(b, c) && isInside(c, a)) return std::abs((x - a).dot(normal));
  return std::min(
      {distanceToSegment(x, a, b), distanceToSegment(x, b, c), distanceToSegment(x, c, a)});
}

Vector3d nearestPoint(const Eigen::Matrix3d& triangle, const Vector3d& x) {
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

}  // namespace ambient
