#include "preprocess/mesh/mend/crack_mending.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "preprocess/mesh/graded_grid.h"

namespace ambient {
namespace {

using Eigen::Vector3d;
using Edge = std::pair<int, int>;

/// Directed edges that no triangle runs along the other way round, as often as one is missing.
std::set<Edge> openEdges(const std::vector<Eigen::Vector3i>& triangles) {
  std::map<Edge, int> count;
  for (const Eigen::Vector3i& t : triangles) {
    for (int k = 0; k < 3; ++k) ++count[{t[k], t[(k + 1) % 3]}];
  }
  std::set<Edge> open;
  for (const auto& [edge, times] : count) {
    const auto back = count.find({edge.second, edge.first});
    if (back == count.end() || back->second < times) open.insert(edge);
  }
  return open;
}

/// A side of a triangle: its first corner and the vertices on it, in order.
struct Side {
  int from = 0;
  std::vector<int> between;
};

class CrackMender {
 public:
  CrackMender(const TriangleMesh& mesh, double tolerance) : tolerance_(tolerance) {
    for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) points_.push_back(mesh.vertices.col(v));
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
      triangles_.push_back(mesh.triangles.col(t));
  }

  /// False if there was nothing to divide.
  bool divideOnce() {
    const std::set<Edge> open = openEdges(triangles_);
    const std::vector<int> ends = endsOf(open);
    std::map<Edge, std::vector<int>> inside;
    for (const Edge& edge : open) {
      std::vector<int> between = verticesOn(edge, ends);
      if (!between.empty()) inside.emplace(edge, std::move(between));
    }
    if (inside.empty()) return false;
    std::vector<Eigen::Vector3i> divided;
    for (const Eigen::Vector3i& triangle : triangles_) append(triangle, inside, divided);
    triangles_ = std::move(divided);
    return true;
  }

  TriangleMesh mesh() const { return makeTriangleMesh(points_, triangles_); }

 private:
  double x(int vertex) const { return points_[static_cast<std::size_t>(vertex)].x(); }

  // In order of x.
  std::vector<int> endsOf(const std::set<Edge>& edges) const {
    std::set<int> ends;
    for (const Edge& edge : edges) ends.insert({edge.first, edge.second});
    std::vector<int> sorted(ends.begin(), ends.end());
    std::sort(sorted.begin(), sorted.end(),
              [&](int v, int w) { return x(v) != x(w) ? x(v) < x(w) : v < w; });
    return sorted;
  }

  // In order along the edge, of those in order of x.
  std::vector<int> verticesOn(const Edge& edge, const std::vector<int>& candidates) const {
    const Vector3d a = points_[static_cast<std::size_t>(edge.first)];
    const Vector3d along = points_[static_cast<std::size_t>(edge.second)] - a;
    const double low = std::min(x(edge.first), x(edge.second));
    const double high = std::max(x(edge.first), x(edge.second));
    const double length = along.norm();
    std::vector<std::pair<double, int>> found;
    const auto first = std::partition_point(candidates.begin(), candidates.end(),
                                            [&](int v) { return x(v) < low - tolerance_; });
    for (auto next = first; next != candidates.end() && x(*next) <= high + tolerance_; ++next) {
      const int v = *next;
      if (v == edge.first || v == edge.second) continue;
      const Vector3d to_v = points_[static_cast<std::size_t>(v)] - a;
      const double s = to_v.dot(along) / length;
      if (s <= 0 || s >= length || (to_v - along * (s / length)).norm() > tolerance_) continue;
      found.emplace_back(s, v);
    }
    std::sort(found.begin(), found.end());
    std::vector<int> vertices;
    for (const auto& [s, v] : found) vertices.push_back(v);
    return vertices;
  }

  void append(const Eigen::Vector3i& triangle, const std::map<Edge, std::vector<int>>& inside,
              std::vector<Eigen::Vector3i>& divided) const {
    std::array<Side, 3> sides;
    for (int k = 0; k < 3; ++k) {
      Side& side = sides[static_cast<std::size_t>(k)];
      side.from = triangle[k];
      const auto found = inside.find({triangle[k], triangle[(k + 1) % 3]});
      if (found == inside.end()) continue;
      for (const int v : found->second) {
        if (v != triangle[(k + 2) % 3]) side.between.push_back(v);  // its own, if it is flat
      }
    }
    divide(sides, divided);
  }

  // At the middle one of the vertices on a side, towards the corner across from it: no part is
  // flatter than the triangle.
  static void divide(std::array<Side, 3> sides, std::vector<Eigen::Vector3i>& divided) {
    for (int turn = 0; turn < 3 && sides[0].between.empty(); ++turn)
      std::rotate(sides.begin(), sides.begin() + 1, sides.end());
    const std::vector<int>& between = sides[0].between;
    if (between.empty()) {
      divided.emplace_back(sides[0].from, sides[1].from, sides[2].from);
      return;
    }
    const auto middle = between.begin() + static_cast<std::ptrdiff_t>(between.size() / 2);
    const Side first{sides[0].from, {between.begin(), middle}};
    const Side second{*middle, {middle + 1, between.end()}};
    divide({first, Side{*middle, {}}, sides[2]}, divided);
    divide({second, sides[1], Side{sides[2].from, {}}}, divided);
  }

  double tolerance_;
  std::vector<Vector3d> points_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace

TriangleMesh withoutCracks(const TriangleMesh& mesh, double tolerance) {
  constexpr int kMostRounds = 8;
  CrackMender mender(mesh, tolerance);
  for (int round = 0; round < kMostRounds; ++round) {
    if (!mender.divideOnce()) break;
  }
  return mender.mesh();
}

}  // namespace ambient
