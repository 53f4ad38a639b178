#include "preprocess/mesh/triangle_quality.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

TriangleQuality qualityOf(const TriangleMesh& mesh, Index t) {
  std::array<double, 3> edges{};
  for (int k = 0; k < 3; ++k) edges[k] = (mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k)).norm();
  std::sort(edges.begin(), edges.end());
  const double twice_area = mesh.twiceArea(t).norm();
  TriangleQuality quality;
  quality.triangle = static_cast<int>(t);
  quality.aspect = edges[2] * edges[2] / twice_area;
  quality.smallest_angle = portable::asin(std::min(1.0, twice_area / (edges[1] * edges[2])));
  quality.barycentre = mesh.barycentre(t);
  return quality;
}

/// Distance along a ray to a triangle, negative if it misses. Moeller and Trumbore 1997.
double distanceAlong(const Vector3d& origin, const Vector3d& direction, const TriangleMesh& mesh,
                     Index t) {
  const Vector3d a = mesh.corner(t, 0);
  const Vector3d ab = mesh.corner(t, 1) - a, ac = mesh.corner(t, 2) - a;
  const Vector3d p = direction.cross(ac);
  const double determinant = ab.dot(p);
  if (determinant == 0) return -1;
  const Vector3d from_a = origin - a;
  const double u = from_a.dot(p) / determinant;
  const Vector3d q = from_a.cross(ab);
  const double v = direction.dot(q) / determinant;
  // Rays through an edge shall not slip between its triangles.
  constexpr double kRounding = 1e-9;
  if (u < -kRounding || v < -kRounding || u + v > 1 + kRounding) return -1;
  return ac.dot(q) / determinant;
}

double thicknessAt(const TriangleMesh& mesh, Index t) {
  const Vector3d origin = mesh.barycentre(t), inwards = -mesh.twiceArea(t).normalized();
  double nearest = -1;
  for (Index s = 0; s < mesh.triangleCount(); ++s) {
    if (s == t || mesh.twiceArea(s).dot(inwards) <= 0) continue;
    const double distance = distanceAlong(origin, inwards, mesh, s);
    if (distance > 0 && (nearest < 0 || distance < nearest)) nearest = distance;
  }
  return nearest;
}

}  // namespace

std::vector<TriangleQuality> findWorstTriangles(const TriangleMesh& mesh, int count) {
  std::vector<TriangleQuality> all;
  for (Index t = 0; t < mesh.triangleCount(); ++t) all.push_back(qualityOf(mesh, t));
  std::stable_sort(all.begin(), all.end(), [](const TriangleQuality& a, const TriangleQuality& b) {
    return a.aspect > b.aspect;
  });
  all.resize(std::min(all.size(), static_cast<std::size_t>(count)));
  return all;
}

std::optional<Thickness> findThinnestPart(const TriangleMesh& mesh) {
  AMBIENT_ASSERT(isClosed(computeMeshEdges(mesh)));
  constexpr Index kMostRays = 2000;
  const Index step = std::max<Index>(1, mesh.triangleCount() / kMostRays);
  std::optional<Thickness> thinnest;
  for (Index t = 0; t < mesh.triangleCount(); t += step) {
    const double thickness = thicknessAt(mesh, t);
    if (thickness < 0 || (thinnest && thinnest->thickness <= thickness)) continue;
    thinnest = Thickness{thickness, static_cast<int>(t), mesh.barycentre(t)};
  }
  return thinnest;
}

}  // namespace ambient
