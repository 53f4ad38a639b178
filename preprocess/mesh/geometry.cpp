#include "preprocess/mesh/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/triangle_mesh.h"

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

namespace {

using Points = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Orthogonal projection along the area vector (Newell), so that the polygon turns to the left.
Points projected(const std::vector<Eigen::Vector3d>& corners) {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d a = corners[i] - corners[0];
    area += a.cross(corners[(i + 1) % corners.size()] - corners[0]);
  }
  const Eigen::Vector3d normal = area.stableNormalized();
  const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  Points points;
  for (const Eigen::Vector3d& corner : corners) {
    points.push_back({u.dot(corner - corners[0]), v.dot(corner - corners[0])});
  }
  return points;
}

/// The remaining polygon while its ears are cut off.
class EarClipping {
 public:
  EarClipping(Points points, const std::set<std::pair<int, int>>& apart)
      : points_(std::move(points)),
        apart_(apart),
        left_(points_.size()),
        blocker_(points_.size(), kUnknown) {
    std::iota(left_.begin(), left_.end(), 0);
  }

  std::vector<Eigen::Vector3i> triangles() {
    std::vector<Eigen::Vector3i> result;
    while (left_.size() > 3) {
      const std::size_t ear = bestEar();
      result.push_back(triangleAt(ear));
      forget(result.back());
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    result.push_back({left_[0], left_[1], left_[2]});
    return result;
  }

 private:
  Eigen::Vector3i triangleAt(std::size_t i) const {
    const std::size_t n = left_.size();
    return {left_[(i + n - 1) % n], left_[i], left_[(i + 1) % n]};
  }

  // Twice the area over the square of the longest side: 0.87 for the best shape, negative at a
  // reflex corner.
  double shape(const Eigen::Vector3i& t) const {
    const Eigen::Vector2d a = points_[t[0]], b = points_[t[1]], c = points_[t[2]];
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return longest > 0 ? cross(b - a, c - a) / longest : 0;
  }

  bool contains(const Eigen::Vector3i& t, const Eigen::Vector2d& p) const {
    const Eigen::Vector2d a = points_[t[0]], b = points_[t[1]], c = points_[t[2]];
    if (p == a || p == b || p == c) return false;
    return cross(b - a, p - a) >= 0 && cross(c - b, p - b) >= 0 && cross(a - c, p - c) >= 0;
  }

  /// Remembers who is in the way: as long as it is there, it still is.
  bool isEmpty(const Eigen::Vector3i& t) {
    int& blocker = blocker_[t[1]];
    if (blocker == kUnknown) {
      const auto found = std::find_if(left_.begin(), left_.end(), [&](int i) {
        return i != t[0] && i != t[1] && i != t[2] && contains(t, points_[i]);
      });
      blocker = found == left_.end() ? kNobody : *found;
    }
    return blocker == kNobody;
  }

  /// Cutting off an ear changes those beside it, and those that it was in the way of.
  void forget(const Eigen::Vector3i& ear) {
    blocker_[ear[0]] = blocker_[ear[2]] = kUnknown;
    std::replace(blocker_.begin(), blocker_.end(), ear[1], kUnknown);
  }

  std::size_t bestEar() {
    std::size_t best = 0, best_regardless = 0;
    double best_shape = 0, best_shape_regardless = -2;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const Eigen::Vector3i triangle = triangleAt(i);
      if (apart_.count(std::minmax({triangle[0], triangle[2]})) > 0) continue;
      const double value = shape(triangle);
      if (value > best_shape_regardless) {
        best_shape_regardless = value;
        best_regardless = i;
      }
      if (value > best_shape && isEmpty(triangle)) {
        best_shape = value;
        best = i;
      }
    }
    return best_shape > 0 ? best : best_regardless;
  }

  static constexpr int kUnknown = -2, kNobody = -1;
  Points points_;
  const std::set<std::pair<int, int>>& apart_;
  std::vector<int> left_;
  std::vector<int> blocker_;  // of each corner: who lies in its ear
};

}  // namespace

std::vector<Eigen::Vector3i> dividePolygon(const std::vector<Eigen::Vector3d>& corners,
                                           const std::set<std::pair<int, int>>& apart) {
  AMBIENT_ASSERT(corners.size() >= 3);
  if (corners.size() == 3) return {{0, 1, 2}};
  return EarClipping(projected(corners), apart).triangles();
}

namespace {

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

}  // namespace ambient
