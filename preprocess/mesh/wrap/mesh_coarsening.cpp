#include "preprocess/mesh/wrap/mesh_coarsening.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <queue>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using CornerNumbers = Eigen::Vector3i;

/// Sum over planes of area times squared distance: x^T A x - 2 b x + c, about a point near by.
struct Quadric {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double c = 0, area = 0;

  void add(const Quadric& other) {
    A += other.A;
    b += other.b;
    c += other.c;
    area += other.area;
  }
  double at(const Vector3d& x) const { return std::max(0.0, x.dot(A * x) - 2 * b.dot(x) + c); }
};

struct Contraction {
  double cost = 0;
  int kept = 0, removed = 0;
  int age = 0;  // of both vertices when it was found
  double error = 0;
  Vector3d place = Vector3d::Zero();

  bool operator<(const Contraction& other) const {  // the cheapest on top of the queue
    if (cost != other.cost) return cost > other.cost;
    return kept != other.kept ? kept > other.kept : removed > other.removed;
  }
};

class MeshCoarsener {
 public:
  explicit MeshCoarsener(const TriangleMesh& mesh)
      : middle_(mesh.bounds().center()),
        vertices_(mesh.vertices.colwise() - middle_),
        around_(static_cast<std::size_t>(mesh.vertexCount())),
        quadrics_(around_.size()),
        ages_(around_.size(), 0),
        faces_(mesh.triangleCount()) {
    for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
      triangles_.emplace_back(mesh.triangles.col(t));
      for (const int v : triangles_.back()) around(v).push_back(t);
      addPlane(triangles_.back());
    }
    for (int v = 0; v < static_cast<int>(around_.size()); ++v) {
      for (const int other : neighboursOf(v))
        if (v < other) queue_.push(contractionOf(v, other));
    }
  }

  TriangleMesh coarsenTo(const CoarseningSettings& settings) {
    const double most_error = settings.tolerance * settings.tolerance;
    while (faces_ > settings.least_faces && !queue_.empty()) {
      const Contraction next = queue_.top();
      queue_.pop();
      if (next.age != ageOf(next.kept, next.removed)) continue;
      if (around(next.kept).empty() || around(next.removed).empty()) continue;
      if (next.error > most_error && faces_ <= settings.most_faces) continue;
      if (isAllowed(next)) contract(next);
    }
    return mesh();
  }

 private:
  std::vector<int>& around(int v) { return around_[static_cast<std::size_t>(v)]; }
  CornerNumbers& corners(int t) { return triangles_[static_cast<std::size_t>(t)]; }
  Quadric& quadric(int v) { return quadrics_[static_cast<std::size_t>(v)]; }
  int ageOf(int v, int w) const {
    return ages_[static_cast<std::size_t>(v)] + ages_[static_cast<std::size_t>(w)];
  }

  Vector3d crossOf(const std::array<Vector3d, 3>& p) const {
    return (p[1] - p[0]).cross(p[2] - p[0]);
  }
  std::array<Vector3d, 3> pointsOf(const CornerNumbers& t) const {
    return {vertices_.col(t[0]), vertices_.col(t[1]), vertices_.col(t[2])};
  }

  void addPlane(const CornerNumbers& t) {
    const Vector3d cross = crossOf(pointsOf(t));
    const double area = cross.norm() / 2;
    const Vector3d normal = cross.stableNormalized();
    const double offset = normal.dot(vertices_.col(t[0]));
    const Quadric plane{area * normal * normal.transpose(), area * offset * normal,
                        area * offset * offset, area};
    for (const int v : t) quadric(v).add(plane);
  }

  std::vector<int> neighboursOf(int v) {
    std::vector<int> neighbours;
    for (const int t : around(v)) {
      for (const int corner : corners(t))
        if (corner != v) neighbours.push_back(corner);
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    return neighbours;
  }

  /// To the point of least error; where planes do not determine it, the middle. Among equals, short
  /// edges go first.
  Contraction contractionOf(int v, int w) {
    constexpr double kUndetermined = 1e-3, kLength = 1e-4;
    Quadric sum = quadric(v);
    sum.add(quadric(w));
    const Vector3d middle = (vertices_.col(v) + vertices_.col(w)) / 2;
    const double length = (vertices_.col(v) - vertices_.col(w)).norm();
    const double weight = kUndetermined * sum.area;
    Contraction found;
    found.kept = v;
    found.removed = w;
    found.age = ageOf(v, w);
    const Matrix3d A = sum.A + weight * Matrix3d::Identity();
    found.place = A.inverse() * (sum.b + weight * middle);
    if (!found.place.allFinite() || (found.place - middle).norm() > length) found.place = middle;
    const double error = sum.at(found.place);
    found.error = sum.area > 0 ? error / sum.area : 0;
    found.cost = error + kLength * sum.area * length * length;
    return found;
  }

  bool isAllowed(const Contraction& c) {
    const std::vector<int> a = neighboursOf(c.kept), b = neighboursOf(c.removed);
    std::vector<int> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    if (common.size() != 2 || a.size() + b.size() < 8) return false;
    return staysInShape(c, c.kept, c.removed) && staysInShape(c, c.removed, c.kept);
  }

  /// Whether the triangles at `v` but not at `other` neither turn nor become slivers. Slivers may
  /// become a little worse: else fans around a pole could not be contracted.
  bool staysInShape(const Contraction& c, int v, int other) {
    constexpr double kLeastCosine = 0.3, kLeastHeightOfTriangle = 0.05, kLeastOfSliver = 0.9;
    for (const int t : around(v)) {
      const CornerNumbers& own = corners(t);
      if ((own.array() == other).any()) continue;
      std::array<Vector3d, 3> points = pointsOf(own);
      const Vector3d before = crossOf(points);
      const double shape_before = shapeOf(points);
      for (int k = 0; k < 3; ++k)
        if (own[k] == v) points[static_cast<std::size_t>(k)] = c.place;
      const Vector3d after = crossOf(points);
      if (before.dot(after) < kLeastCosine * before.norm() * after.norm()) return false;
      if (shapeOf(points) < std::min(kLeastHeightOfTriangle, kLeastOfSliver * shape_before))
        return false;
    }
    return true;
  }

  /// Height over longest edge.
  double shapeOf(const std::array<Vector3d, 3>& p) const {
    const double longest = std::max(
        {(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
    return longest > 0 ? crossOf(p).norm() / longest : 0;
  }

  void contract(const Contraction& c) {
    vertices_.col(c.kept) = c.place;
    quadric(c.kept).add(quadric(c.removed));
    std::vector<int> left;
    for (const int t : around(c.kept)) {
      if ((corners(t).array() == c.removed).any()) {
        for (const int v : corners(t))
          if (v != c.kept && v != c.removed) remove(t, v);
        --faces_;
      } else {
        left.push_back(t);
      }
    }
    for (const int t : around(c.removed)) {
      if ((corners(t).array() == c.kept).any()) {
        corners(t).setConstant(-1);
        continue;
      }
      for (int& v : corners(t))
        if (v == c.removed) v = c.kept;
      left.push_back(t);
    }
    around(c.removed).clear();
    around(c.kept) = std::move(left);
    ++ages_[static_cast<std::size_t>(c.kept)];
    for (const int v : neighboursOf(c.kept))
      queue_.push(contractionOf(std::min(v, c.kept), std::max(v, c.kept)));
  }

  void remove(int t, int v) {
    std::vector<int>& own = around(v);
    own.erase(std::find(own.begin(), own.end(), t));
  }

  TriangleMesh mesh() const {
    std::vector<CornerNumbers> left;
    for (const CornerNumbers& t : triangles_)
      if (t[0] >= 0) left.push_back(t);
    TriangleMesh result = withUsedVertices(vertices_, left);
    result.vertices.colwise() += middle_;
    return result;
  }

  Vector3d middle_;
  Eigen::Matrix3Xd vertices_;
  std::vector<CornerNumbers> triangles_;  // -1: removed
  std::vector<std::vector<int>> around_;  // per vertex: its triangles
  std::vector<Quadric> quadrics_;
  std::vector<int> ages_;
  Eigen::Index faces_;
  std::priority_queue<Contraction> queue_;
};

}  // namespace

TriangleMesh coarsened(const TriangleMesh& mesh, const CoarseningSettings& settings) {
  AMBIENT_ASSERT(isClosed(computeMeshEdges(mesh)));
  return MeshCoarsener(mesh).coarsenTo(settings);
}

}  // namespace ambient
