#include "preprocess/mesh/holds/hold_labels.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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

}  // namespace ambient
