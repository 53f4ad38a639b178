#include "preprocess/mesh/holds/pools.h"

#include <algorithm>
#include <array>
#include <list>
#include <numeric>
#include <utility>

namespace ambient {
namespace {

constexpr double kLeastDepth = 1e-3;  // of a part that counts, over the size of the mesh
constexpr double kLeastPool = 0.01;   // of a pool, over its bounding box
constexpr double kBulkhead = 0.8;     // depth of a pool apart, over that to the spill
constexpr double kLeastShare = 0.05;  // of a pool apart, of the whole

/// A part of the surface below the level.
struct Part {
  std::list<int> vertices, cut;  ///< all; the triangles that the level may cut
  int lowest = -1;
  double area = 0, moment = 0;  ///< sums over the triangles below: A u.n, and that times the height
  std::vector<Pool> stages;     ///< pools that have met in it, as they were; empty: none have
};

class JoinTree {
 public:
  JoinTree(const TriangleMesh& mesh, const Eigen::Vector3d& up)
      : mesh_(mesh),
        heights_(mesh.vertices.transpose() * up),
        sets_(static_cast<std::size_t>(mesh.vertexCount())),
        parts_(static_cast<std::size_t>(mesh.vertexCount())) {
    heights_.array() -= heights_.minCoeff();
    least_depth_ = kLeastDepth * mesh.extents().maxCoeff();
    least_volume_ = kLeastPool * mesh.extents().prod();
    up_area_.resize(mesh.triangleCount());
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
      up_area_[t] = mesh.twiceArea(t).dot(up) / 2;
    sortVertices();
    listNeighbours();
  }

  std::vector<Pool> pools() {
    for (const int v : order_) visit(v);
    return std::move(pools_);
  }

 private:
  void sortVertices() {
    order_.resize(static_cast<std::size_t>(mesh_.vertexCount()));
    std::iota(order_.begin(), order_.end(), 0);
    std::sort(order_.begin(), order_.end(), [this](int a, int b) {
      return std::make_pair(heights_[a], a) < std::make_pair(heights_[b], b);
    });
    rank_.resize(order_.size());
    for (std::size_t i = 0; i < order_.size(); ++i) rank_[order_[i]] = static_cast<int>(i);
  }

  /// Sorts each edge to its upper end, each triangle to its lowest corner.
  void listNeighbours() {
    lower_.resize(order_.size());
    begun_.resize(order_.size());
    for (int t = 0; t < static_cast<int>(mesh_.triangleCount()); ++t) {
      const auto corners = mesh_.triangles.col(t);
      for (int k = 0; k < 3; ++k) {
        const int a = corners[k], b = corners[(k + 1) % 3];
        if (rank_[a] < rank_[b]) lower_[b].push_back(a);
        if (rank_[b] < rank_[a]) lower_[a].push_back(b);
      }
      int low = 0;
      for (int k = 1; k < 3; ++k)
        if (rank_[corners[k]] < rank_[corners[low]]) low = k;
      begun_[corners[low]].push_back(t);
    }
  }

  std::vector<int> partsBelow(int v) {
    std::vector<int> roots;
    for (const int w : lower_[v]) roots.push_back(sets_.find(w));
    std::sort(roots.begin(), roots.end());
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    return roots;
  }

  /// Takes the triangles that lie below the level out of those that it may cut.
  void settle(Part& part, int level_rank) {
    part.cut.remove_if([&](int t) {
      double sum = 0;
      for (const int corner : mesh_.triangles.col(t)) {
        if (rank_[corner] >= level_rank) return false;
        sum += heights_[corner];
      }
      part.area += up_area_[t];
      part.moment += up_area_[t] * sum / 3;
      return true;
    });
  }

  /// -int (u.n) zeta dA over what lies below the level, eq. (54): the volume of the part with its
  /// cap; negative: a pool.
  double volumeBelow(const Part& part, double level) const {
    double volume = part.moment - part.area * level;
    for (const int t : part.cut) {
      std::array<double, 3> depth;
      for (int k = 0; k < 3; ++k) depth[k] = level - heights_[mesh_.triangles(k, t)];
      std::sort(depth.begin(), depth.end());
      double mean = (depth[0] + depth[1] + depth[2]) / 3;
      if (depth[2] <= 0) continue;
      if (depth[0] < 0) {
        // The lone corner on its side of the level cuts off a triangle like the whole one.
        const bool is_one_below = depth[1] <= 0;
        const double lone = is_one_below ? depth[2] : depth[0];
        const double other = is_one_below ? depth[0] : depth[2];
        const double cut = lone / (lone - depth[1]) * (lone / (lone - other)) * lone / 3;
        mean = is_one_below ? cut : mean - cut;
      }
      volume -= up_area_[t] * mean;
    }
    return volume;
  }

  void visit(int v) {
    const std::vector<int> roots = partsBelow(v);
    meet(v, roots);
    Part all;
    all.vertices.push_back(v);
    all.cut = std::move(begun_[v]);
    all.lowest = v;
    for (const int root : roots) {
      Part& part = parts_[root];
      all.vertices.splice(all.vertices.end(), part.vertices);
      all.cut.splice(all.cut.end(), part.cut);
      if (rank_[part.lowest] < rank_[all.lowest]) all.lowest = part.lowest;
      all.area += part.area;
      all.moment += part.moment;
      std::move(part.stages.begin(), part.stages.end(), std::back_inserter(all.stages));
      part = {};
      sets_.join(v, root);
    }
    parts_[sets_.find(v)] = std::move(all);
  }

  /// Lets pools spill at a vertex where parts meet, or remember what they were.
  void meet(int v, const std::vector<int>& roots) {
    std::vector<int> deep;
    for (const int root : roots)
      if (heights_[v] - heights_[parts_[root].lowest] > least_depth_) deep.push_back(root);
    if (deep.size() < 2) return;
    double outside = 0;  // volume of the largest solid part
    std::vector<std::pair<int, double>> pools;
    for (const int root : deep) {
      settle(parts_[root], rank_[v]);
      const double volume = volumeBelow(parts_[root], heights_[v]);
      outside = std::max(outside, volume);
      if (volume < 0) pools.emplace_back(root, -volume);
    }
    for (const auto& [root, volume] : pools) {
      Part& part = parts_[root];
      const auto now = [&, volume = volume] {
        return Pool{{part.vertices.begin(), part.vertices.end()},
                    part.lowest,
                    heights_[v] - heights_[part.lowest],
                    volume};
      };
      if (!(outside > volume)) {
        if (pools.size() > 1 && part.stages.empty()) part.stages.push_back(now());
        continue;
      }
      if (volume > least_volume_) spill(part, now());
      part.stages.clear();
    }
  }

  void spill(const Part& part, const Pool& whole) {
    std::vector<Pool> apart;
    for (const Pool& stage : part.stages) {
      if (stage.depth > kBulkhead * whole.depth && stage.volume > kLeastShare * whole.volume)
        apart.push_back(stage);
    }
    if (apart.size() < 2) apart = {whole};
    std::move(apart.begin(), apart.end(), std::back_inserter(pools_));
  }

  const TriangleMesh& mesh_;
  Eigen::VectorXd heights_, up_area_;  // above the lowest vertex [m]; A u.n [m^2]
  double least_depth_ = 0, least_volume_ = 0;
  std::vector<int> order_, rank_;        // by height
  std::vector<std::vector<int>> lower_;  // neighbours of a vertex
  std::vector<std::list<int>> begun_;    // triangles whose lowest corner a vertex is
  DisjointSets sets_;
  std::vector<Part> parts_;  // of a root
  std::vector<Pool> pools_;
};

}  // namespace

std::vector<Pool> findPools(const TriangleMesh& mesh, const Eigen::Vector3d& up) {
  return JoinTree(mesh, up).pools();
}

}  // namespace ambient
