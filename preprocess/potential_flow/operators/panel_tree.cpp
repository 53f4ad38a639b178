#include "preprocess/potential_flow/operators/panel_tree.h"

#include <algorithm>
#include <numeric>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/potential_flow/surface/panel_pair.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Builds the clusters over a permutation of the panels.
class Splitter {
 public:
  Splitter(const PanelSurface& surface, int leaf_size) : surface_(surface), leaf_size_(leaf_size) {
    order_.resize(surface.panelCount());
    std::iota(order_.begin(), order_.end(), 0);
  }

  void split(PanelTree& tree) {
    addCluster(tree, 0, surface_.panelCount(), -1);
    for (std::size_t c = 0; c < tree.clusters.size(); ++c) {
      const PanelCluster cluster = tree.clusters[c];
      if (cluster.count <= leaf_size_) continue;
      const Index half = cluster.count / 2;
      sortAcrossLongestSide(cluster, half);
      const int parent = static_cast<int>(c);
      const int low = addCluster(tree, cluster.first, half, parent);
      const int high = addCluster(tree, cluster.first + half, cluster.count - half, parent);
      tree.clusters[c].children = {low, high};
    }
  }

  const std::vector<int>& order() const { return order_; }

 private:
  int addCluster(PanelTree& tree, Index first, Index count, int parent) const {
    PanelCluster cluster;
    cluster.first = first;
    cluster.count = count;
    cluster.parent = parent;
    Eigen::AlignedBox3d box;
    for (Index k = first; k < first + count; ++k) {
      const Panel& panel = surface_.panels[order_[k]];
      for (const Vector3d& corner : panel.corner) box.extend(corner);
      cluster.panel_radius = std::max(cluster.panel_radius, panel.radius);
    }
    cluster.centre = box.center();
    for (Index k = first; k < first + count; ++k)
      for (const Vector3d& corner : surface_.panels[order_[k]].corner)
        cluster.radius = std::max(cluster.radius, (corner - cluster.centre).norm());
    tree.clusters.push_back(cluster);
    return static_cast<int>(tree.clusters.size()) - 1;
  }

  void sortAcrossLongestSide(const PanelCluster& cluster, Index half) {
    Eigen::AlignedBox3d box;
    const auto first = order_.begin() + cluster.first;
    for (auto k = first; k != first + cluster.count; ++k) box.extend(surface_.panels[*k].centroid);
    Index axis = 0;
    box.sizes().maxCoeff(&axis);
    std::nth_element(first, first + half, first + cluster.count, [&](int a, int b) {
      const double x = surface_.panels[a].centroid[axis], y = surface_.panels[b].centroid[axis];
      return x != y ? x < y : a < b;
    });
  }

  const PanelSurface& surface_;
  Index leaf_size_;
  std::vector<int> order_;
};

PanelSurface inOrder(const PanelSurface& surface, const std::vector<int>& order) {
  PanelSurface result = surface;
  AMBIENT_ASSERT(order.size() == surface.panels.size());
  for (std::size_t t = 0; t < order.size(); ++t) {
    result.triangles.col(static_cast<Index>(t)) = surface.triangles.col(order[t]);
    result.panels[t] = surface.panels[order[t]];
  }
  fillFromPanels(result);
  return result;
}

void listLevelsAndLeaves(PanelTree& tree) {
  std::vector<std::size_t> depth(tree.clusters.size(), 0);
  for (std::size_t c = 0; c < tree.clusters.size(); ++c) {
    const PanelCluster& cluster = tree.clusters[c];
    if (cluster.parent >= 0) depth[c] = depth[cluster.parent] + 1;
    if (depth[c] == tree.levels.size()) tree.levels.emplace_back();
    tree.levels[depth[c]].push_back(static_cast<int>(c));
    if (cluster.isLeaf()) tree.leaves.push_back(static_cast<int>(c));
  }
  std::sort(tree.leaves.begin(), tree.leaves.end(),
            [&](int a, int b) { return tree.clusters[a].first < tree.clusters[b].first; });
  for (std::size_t k = 0; k < tree.leaves.size(); ++k)
    tree.leaf_of_panel.insert(tree.leaf_of_panel.end(), tree.clusters[tree.leaves[k]].count,
                              static_cast<int>(k));
}

/// Sorts all pairs of clusters by descending from the root with itself.
class Pairing {
 public:
  Pairing(const PanelTree& tree, double opening) : tree_(tree), opening_(opening) {
    pairs_.far.resize(tree.clusters.size());
    pairs_.near.resize(tree.leaves.size());
  }

  ClusterPairs run() {
    pair(0, 0);
    for (std::vector<int>& list : pairs_.near) std::sort(list.begin(), list.end());
    return std::move(pairs_);
  }

 private:
  void pair(int a, int b) {
    const PanelCluster& t = tree_.clusters[a];
    const PanelCluster& s = tree_.clusters[b];
    if (a == b) {
      if (t.isLeaf()) return addNear(a, a);
      pair(t.children[0], t.children[0]);
      pair(t.children[0], t.children[1]);
      pair(t.children[1], t.children[1]);
    } else if (isFar(t, s)) {
      pairs_.far[a].push_back(b);
      pairs_.far[b].push_back(a);
    } else if (t.isLeaf() && s.isLeaf()) {
      addNear(a, b);
    } else if (s.isLeaf() || (!t.isLeaf() && t.radius >= s.radius)) {
      for (const int child : t.children) pair(child, b);
    } else {
      for (const int child : s.children) pair(a, child);
    }
  }

  bool isFar(const PanelCluster& t, const PanelCluster& s) const {
    const double distance = (t.centre - s.centre).norm(), radii = t.radius + s.radius;
    return radii <= opening_ * distance &&
           distance - radii > kFarLimit * (t.panel_radius + s.panel_radius);
  }

  void addNear(int a, int b) {
    const int t = tree_.leaf_of_panel[tree_.clusters[a].first];
    const int s = tree_.leaf_of_panel[tree_.clusters[b].first];
    pairs_.near[t].push_back(s);
    if (s != t) pairs_.near[s].push_back(t);
  }

  const PanelTree& tree_;
  double opening_;
  ClusterPairs pairs_;
};

}  // namespace

PanelTree makePanelTree(const PanelSurface& surface, int leaf_size) {
  PanelTree tree;
  Splitter splitter(surface, leaf_size);
  splitter.split(tree);
  tree.surface = inOrder(surface, splitter.order());
  listLevelsAndLeaves(tree);
  return tree;
}

ClusterPairs pairClusters(const PanelTree& tree, double opening) {
  AMBIENT_ASSERT(opening > 0 && opening < 1 && !tree.clusters.empty());
  return Pairing(tree, opening).run();
}

}  // namespace ambient
