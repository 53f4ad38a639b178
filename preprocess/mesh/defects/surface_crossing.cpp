#include "preprocess/mesh/defects/surface_crossing.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/geometry.h"

namespace ambient {

double solidAngle(const TriangleMesh& mesh, Eigen::Index triangle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d a = mesh.corner(triangle, 0) - point;
  const Eigen::Vector3d b = mesh.corner(triangle, 1) - point;
  const Eigen::Vector3d c = mesh.corner(triangle, 2) - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double numerator = a.dot(b.cross(c));
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  constexpr double kSmall = 0.01;  // of the tangent; what the series leaves out is below rounding
  if (!(std::abs(numerator) < kSmall * denominator))
    return 2 * portable::atan2(numerator, denominator);
  const double tangent = numerator / denominator, square = tangent * tangent;
  return 2 * tangent * (1 - square * (1.0 / 3 - square * (1.0 / 5 - square / 7)));
}

double solidAngle(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double angle = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) angle += solidAngle(mesh, t, point);
  return angle;
}

double enclosedVolume(const TriangleMesh& mesh) {
  constexpr double kAngles = 2e8;
  const auto triangles = static_cast<double>(mesh.triangleCount());
  const int count = static_cast<int>(std::clamp(portable::cbrt(kAngles / triangles), 8.0, 24.0));
  const Eigen::Vector3d low = mesh.vertices.rowwise().minCoeff(), step = mesh.extents() / count;
  int inside = 0;
  for (int i = 0; i < count * count * count; ++i) {
    const int x = i % count, y = i / count % count, z = i / (count * count);
    const Eigen::Array3d place(x, y, z);
    const Eigen::Vector3d point = low.array() + (place + 0.5) * step.array();
    inside += std::abs(solidAngle(mesh, point)) > 2 * kPi ? 1 : 0;
  }
  return inside * step.prod();
}

namespace {

using Eigen::Index;
using Eigen::Vector3d;

double sixfoldVolume(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Distance below which parts touch, for a surface scaled to unit size. The scale keeps products of
/// lengths in the range of a double, whatever the unit.
constexpr double kTouch = 1e-6;

TriangleMesh inUnitSize(TriangleMesh mesh) {
  const Vector3d low = mesh.vertices.rowwise().minCoeff(),
                 high = mesh.vertices.rowwise().maxCoeff();
  mesh.vertices = (mesh.vertices.colwise() - (low + high) / 2) / (high - low).norm();
  return mesh;
}

/// Extent of a triangle along the direction of the sweep, and its bounding box.
struct Extent {
  double first = 0, last = 0;
  Eigen::AlignedBox3d bounds;
  int triangle = 0;
};

std::vector<Extent> sortedExtents(const TriangleMesh& mesh) {
  // Along no side of anything that is likely: all triangles of such a side would overlap.
  const Vector3d direction = Vector3d(0.73, 0.55, 0.41).normalized();
  std::vector<Extent> extents;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const auto along = {direction.dot(mesh.corner(t, 0)), direction.dot(mesh.corner(t, 1)),
                        direction.dot(mesh.corner(t, 2))};
    extents.push_back({std::min(along), std::max(along), boundsOf(mesh, t), static_cast<int>(t)});
  }
  std::sort(extents.begin(), extents.end(), [](const Extent& p, const Extent& q) {
    return p.first != q.first ? p.first < q.first : p.triangle < q.triangle;
  });
  return extents;
}

bool haveCommonCorner(const TriangleMesh& mesh, int s, int t) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (mesh.triangles(i, s) == mesh.triangles(j, t)) return true;
    }
  }
  return false;
}

bool edgesCross(const TriangleMesh& mesh, int s, int t) {
  for (int k = 0; k < 3; ++k) {
    if (crossesTriangle(mesh.corner(s, k), mesh.corner(s, (k + 1) % 3), mesh, t)) return true;
  }
  return false;
}

bool cornersTouch(const TriangleMesh& mesh, int s, int t) {
  for (int k = 0; k < 3; ++k) {
    if (isCloser(mesh.corner(s, k), mesh, t, kTouch)) return true;
  }
  return false;
}

}  // namespace

SurfaceCrossings findSurfaceCrossings(const TriangleMesh& source, const std::vector<int>& part_of) {
  AMBIENT_ASSERT(source.vertices.allFinite());
  AMBIENT_ASSERT(static_cast<Eigen::Index>(part_of.size()) == source.triangleCount());
  const TriangleMesh mesh = inUnitSize(source);
  const std::vector<Extent> extents = sortedExtents(mesh);
  SurfaceCrossings found;
  for (std::size_t i = 0; i < extents.size(); ++i) {
    const int s = extents[i].triangle;
    for (std::size_t j = i + 1; j < extents.size() && extents[j].first <= extents[i].last + kTouch;
         ++j) {
      const int t = extents[j].triangle;
      const bool same_part = part_of[s] == part_of[t];
      if ((same_part && found.within_part) ||
          !areNear(extents[i].bounds, extents[j].bounds, kTouch))
        continue;
      if (haveCommonCorner(mesh, s, t)) continue;
      const bool cross = edgesCross(mesh, s, t) || edgesCross(mesh, t, s);
      if (same_part) {
        if (cross) found.within_part = TrianglePair{s, t};
      } else if (cross || cornersTouch(mesh, s, t) || cornersTouch(mesh, t, s)) {
        found.between_parts = TrianglePair{s, t};
        return found;
      }
    }
  }
  return found;
}

bool crossesTriangle(const Vector3d& p, const Vector3d& q, const TriangleMesh& mesh, Index t) {
  const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
  if (sixfoldVolume(a, b, c, p) * sixfoldVolume(a, b, c, q) > 0) return false;
  const double u = sixfoldVolume(p, q, a, b), v = sixfoldVolume(p, q, b, c),
               w = sixfoldVolume(p, q, c, a);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

}  // namespace ambient
