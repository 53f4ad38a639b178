#include "preprocess/mesh/holds/level_rims.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "preprocess/mesh/holds/hold_labels.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

constexpr double kSearched = 0.005;  // of the depth, below where a pool spills
constexpr double kSameLevel = 1e-9;  // of the depth

/// Divides the triangles that cross a height into three each. Both triangles of an edge get the
/// same new vertex, so that the mesh stays closed.
class Divider {
 public:
  Divider(const TriangleMesh& mesh, const Vector3d& up, double level)
      : mesh_(mesh), heights_(mesh.vertices.transpose() * up), level_(level) {
    for (const auto& corners : mesh.triangles.colwise()) divide(corners);
  }

  TriangleMesh mesh() const {
    TriangleMesh divided = mesh_;
    divided.vertices.conservativeResize(
        3, mesh_.vertexCount() + static_cast<Eigen::Index>(added_.size()));
    for (std::size_t i = 0; i < added_.size(); ++i)
      divided.vertices.col(mesh_.vertexCount() + static_cast<Eigen::Index>(i)) = added_[i];
    divided.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
    for (std::size_t i = 0; i < triangles_.size(); ++i)
      divided.triangles.col(static_cast<Eigen::Index>(i)) = triangles_[i];
    return divided;
  }

 private:
  bool isAbove(int vertex) const { return heights_[vertex] >= level_; }

  int vertexOn(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const int next = static_cast<int>(mesh_.vertexCount()) + static_cast<int>(added_.size());
    const auto [place, is_new] = vertex_on_.emplace(std::pair(low, high), next);
    if (is_new) {
      const Vector3d from = mesh_.vertices.col(low), to = mesh_.vertices.col(high);
      const double share = (level_ - heights_[low]) / (heights_[high] - heights_[low]);
      added_.push_back(from + share * (to - from));
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

  const TriangleMesh& mesh_;
  const Eigen::VectorXd heights_;
  const double level_;
  std::map<std::pair<int, int>, int> vertex_on_;  // an edge, (low, high)
  std::vector<Vector3d> added_;
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
