#include "preprocess/mesh/holds/hold_labels.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <queue>
#include <set>
#include <utility>

namespace ambient {

namespace {

constexpr int kNobody = -1;
constexpr double kRimCosine = 0.76604444;  // of 40 degrees: more is a rim
constexpr double kLabelRounding = 1e-9;

/// Grows the labels of some triangles over all of them.
class Watershed {
 public:
  Watershed(const TriangleMesh& mesh, const TriangleNeighbours& neighbours,
            const Eigen::Vector3d& up)
      : mesh_(mesh),
        neighbours_(neighbours),
        up_(up),
        size_(mesh.extents().maxCoeff()),
        labels_(static_cast<std::size_t>(mesh.triangleCount()), kNobody) {
    for (int t = 0; t < static_cast<int>(labels_.size()); ++t) {
      heights_.push_back(mesh.barycentre(t).dot(up));
      normals_.push_back(mesh.twiceArea(t).stableNormalized());
    }
  }

  void seedHolds(const std::vector<Pool>& pools) {
    std::vector<int> pool_of(static_cast<std::size_t>(mesh_.vertexCount()), kNobody);
    std::vector<int> lowest_of(pool_of);
    for (std::size_t p = 0; p < pools.size(); ++p) {
      for (const int v : pools[p].vertices) pool_of[v] = static_cast<int>(p) + 1;
      lowest_of[pools[p].lowest] = static_cast<int>(p) + 1;
    }
    for (std::size_t t = 0; t < labels_.size(); ++t) {
      const Eigen::Vector3i corners = mesh_.triangles.col(static_cast<Eigen::Index>(t));
      const int pool = pool_of[corners[0]];
      if (pool == pool_of[corners[1]] && pool == pool_of[corners[2]]) labels_[t] = pool;
      for (const int corner : corners)
        if (lowest_of[corner] != kNobody) labels_[t] = lowest_of[corner];
    }
  }

  /// Labels the faces at the farthest points to the sides and below that look there.
  void seedOutside() {
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3d way =
          Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1).cast<double>();
      if (way.isZero(0) || way.dot(up_) > way.norm() / 2) continue;
      const Eigen::VectorXd far = mesh_.vertices.transpose() * way;
      const double farthest = far.maxCoeff() - kLabelRounding * size_;
      for (std::size_t t = 0; t < labels_.size(); ++t) {
        const auto corners = mesh_.triangles.col(static_cast<Eigen::Index>(t));
        if (labels_[t] == kNobody && normals_[t].dot(way) > 0 &&
            (far[corners[0]] > farthest || far[corners[1]] > farthest ||
             far[corners[2]] > farthest))
          labels_[t] = 0;
      }
    }
  }

  /// Grows in the order of height; labels from `stopped` on do not cross rims. If `joins`, labels
  /// of holds that meet become one.
  void grow(int stopped, bool joins) {
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (int t = 0; t < static_cast<int>(labels_.size()); ++t)
      if (labels_[t] != kNobody) open.emplace(heights_[t], t);
    while (!open.empty()) {
      const auto [height, t] = open.top();
      open.pop();
      for (int side = 0; side < 3; ++side) {
        const int other = neighbours_.across(t, side).triangle;
        const int mine = labels_[t], its = labels_[other];
        const bool is_rim = isRim(t, other);
        if (joins && mine > 0 && its > 0 && mine != its && !is_rim)
          std::replace(labels_.begin(), labels_.end(), std::max(mine, its), std::min(mine, its));
        if (its != kNobody || (is_rim && mine >= stopped)) continue;
        labels_[other] = mine;
        open.emplace(std::max(height, heights_[other]), other);
      }
    }
  }

  /// What nobody has reached are parts of their own, outside. Holds that became others leave no gap
  /// in the numbers.
  std::vector<int> labels() {
    std::replace(labels_.begin(), labels_.end(), kNobody, 0);
    std::set<int> used(labels_.begin(), labels_.end());
    used.insert(0);
    for (int& label : labels_)
      label = static_cast<int>(std::distance(used.begin(), used.find(label)));
    return labels_;
  }

 private:
  bool isRim(int t, int other) const {
    return normals_[t].dot(normals_[other]) < kRimCosine &&
           (mesh_.barycentre(other) - mesh_.barycentre(t)).dot(normals_[t]) <
               -kLabelRounding * size_;
  }

  const TriangleMesh& mesh_;
  const TriangleNeighbours& neighbours_;
  const Eigen::Vector3d up_;
  const double size_;
  std::vector<int> labels_;
  std::vector<double> heights_;
  std::vector<Eigen::Vector3d> normals_;
};

}  // namespace

TriangleNeighbours::TriangleNeighbours(const TriangleMesh& mesh)
    : sides_(3 * static_cast<std::size_t>(mesh.triangleCount())) {
  for (const auto& [p, q] : edgePairs(computeMeshEdges(mesh))) {
    sides_[3 * p.triangle + p.side] = {q.triangle, q.side};
    sides_[3 * q.triangle + q.side] = {p.triangle, p.side};
  }
}

std::vector<int> labelTriangles(const TriangleMesh& mesh, const TriangleNeighbours& neighbours,
                                const Eigen::Vector3d& up, const std::vector<Pool>& pools,
                                bool is_tilted) {
  Watershed watershed(mesh, neighbours, up);
  watershed.seedHolds(pools);
  watershed.seedOutside();
  const int holds = static_cast<int>(pools.size());
  watershed.grow(0, is_tilted);          // nobody crosses rims: round ones are met on their crest
  watershed.grow(1, is_tilted);          // the outside does: flat rims, holes in walls
  watershed.grow(holds + 1, is_tilted);  // all do: what holds surround, such as thwarts
  return watershed.labels();
}

namespace {

using Eigen::Vector3d;

constexpr double kSearched = 0.005;  // of the depth, below where a pool spills
constexpr double kSameLevel = 1e-9;  // of the depth

/// Divides the triangles that cross a height into three each. Both triangles of an edge get the
/// same new vertex, so that the mesh stays closed.
class Divider {
 public:
  Divider(const TriangleMesh& mesh, const Vector3d& up, double level)
      : heights_(mesh.vertices.transpose() * up),
        level_(level),
        vertices_(columnsOf(mesh.vertices)) {
    for (const auto& corners : mesh.triangles.colwise()) divide(corners);
  }

  TriangleMesh mesh() const { return makeTriangleMesh(vertices_, triangles_); }

 private:
  bool isAbove(int vertex) const { return heights_[vertex] >= level_; }

  int vertexOn(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [place, is_new] =
        vertex_on_.emplace(std::pair(low, high), static_cast<int>(vertices_.size()));
    if (is_new) {
      const Vector3d from = vertices_[low], to = vertices_[high];
      const double share = (level_ - heights_[low]) / (heights_[high] - heights_[low]);
      vertices_.push_back(from + share * (to - from));
    }
    return place->second;
  }

  void divide(const Eigen::Vector3i& t) {
    int lone = 0;  // the corner on its side of the level
    while (lone < 3 && (isAbove(t[lone]) == isAbove(t[(lone + 1) % 3]) ||
                        isAbove(t[lone]) == isAbove(t[(lone + 2) % 3])))
      ++lone;
    if (lone == 3) {
      triangles_.push_back(t);
      return;
    }
    const int a = t[lone], b = t[(lone + 1) % 3], c = t[(lone + 2) % 3];
    const int p = vertexOn(a, b), q = vertexOn(a, c);
    triangles_.insert(triangles_.end(), {{a, p, q}, {p, b, c}, {p, c, q}});
  }

  const Eigen::VectorXd heights_;
  const double level_;
  std::map<std::pair<int, int>, int> vertex_on_;  // an edge, (low, high)
  std::vector<Vector3d> vertices_;                // those of the mesh first
  std::vector<Eigen::Vector3i> triangles_;
};

/// Returns where holds end, one level for each pool: a little below where it spills, in the middle
/// of the widest gap between the heights of vertices there, so that no triangle is cut at a corner.
std::vector<double> levelsOf(const TriangleMesh& mesh, const Vector3d& up,
                             const std::vector<Pool>& pools) {
  const Eigen::VectorXd heights = mesh.vertices.transpose() * up;
  std::vector<double> levels;
  for (const Pool& pool : pools) {
    const double spill = heights[pool.lowest] + pool.depth;
    std::vector<double> marks{spill - kSearched * pool.depth, spill};
    for (const double height : heights)
      if (height > marks[0] && height < spill) marks.push_back(height);
    std::sort(marks.begin(), marks.end());
    double level = spill, widest = 0;
    for (std::size_t i = 1; i < marks.size(); ++i) {
      if (!(marks[i] - marks[i - 1] > widest)) continue;
      widest = marks[i] - marks[i - 1];
      level = (marks[i] + marks[i - 1]) / 2;
    }
    const auto same = std::find_if(levels.begin(), levels.end(), [&](double other) {
      return std::abs(level - other) <= kSameLevel * pool.depth;
    });
    levels.push_back(same == levels.end() ? level : *same);
  }
  return levels;
}

}  // namespace

LevelRims levelRims(TriangleMesh mesh, const Vector3d& up, const std::vector<Pool>& pools) {
  const std::vector<double> levels = levelsOf(mesh, up, pools);
  for (auto level = levels.begin(); level != levels.end(); ++level)
    if (std::find(levels.begin(), level, *level) == level) mesh = Divider(mesh, up, *level).mesh();
  const TriangleNeighbours neighbours(mesh);
  std::vector<int> labels(static_cast<std::size_t>(mesh.triangleCount()), 0);
  for (std::size_t k = 0; k < pools.size(); ++k) {
    const double level = levels[k];
    std::vector<int> open;
    const auto reach = [&](int t) {
      if (labels[t] != 0 || mesh.barycentre(t).dot(up) >= level) return;
      labels[t] = static_cast<int>(k) + 1;
      open.push_back(t);
    };
    for (int t = 0; t < static_cast<int>(labels.size()); ++t)
      if ((mesh.triangles.col(t).array() == pools[k].lowest).any()) reach(t);
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      for (int side = 0; side < 3; ++side) reach(neighbours.across(t, side).triangle);
    }
  }
  return {std::move(mesh), std::move(labels)};
}

}  // namespace ambient
