#include "preprocess/mesh/polygon_triangles.h"

#include <algorithm>
#include <numeric>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
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
  explicit EarClipping(Points points) : points_(std::move(points)), left_(points_.size()) {
    std::iota(left_.begin(), left_.end(), 0);
  }

  std::vector<Eigen::Vector3i> triangles() {
    std::vector<Eigen::Vector3i> result;
    while (left_.size() > 3) {
      const std::size_t ear = bestEar();
      result.push_back(triangleAt(ear));
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

  bool isEmpty(const Eigen::Vector3i& t) const {
    return std::none_of(left_.begin(), left_.end(), [&](int i) {
      return i != t[0] && i != t[1] && i != t[2] && contains(t, points_[i]);
    });
  }

  std::size_t bestEar() const {
    std::size_t best = 0, best_regardless = 0;
    double best_shape = 0, best_shape_regardless = -2;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const Eigen::Vector3i triangle = triangleAt(i);
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

  Points points_;
  std::vector<int> left_;
};

}  // namespace

std::vector<Eigen::Vector3i> dividePolygon(const std::vector<Eigen::Vector3d>& corners) {
  AMBIENT_ASSERT(corners.size() >= 3);
  if (corners.size() == 3) return {{0, 1, 2}};
  return EarClipping(projected(corners)).triangles();
}

}  // namespace ambient
