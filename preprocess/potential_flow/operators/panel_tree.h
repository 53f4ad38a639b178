#pragma once

#include <vector>

#include "preprocess/potential_flow/surface/panel_surface.h"

namespace ambient {

/// Panels that lie together: `count` of them from `first` on.
struct PanelCluster {
  Eigen::Index first = 0, count = 0;
  int parent = -1;                        ///< -1: of the root
  std::array<int, 2> children{{-1, -1}};  ///< -1: of a leaf
  Eigen::Vector3d centre;                 ///< of the box around its corners
  double radius = 0;                      ///< largest distance of a corner from the centre
  double panel_radius = 0;                ///< largest radius of its panels

  bool isLeaf() const { return children[0] < 0; }
};

/// Binary tree of clusters, halved across their longest side. The surface is a copy whose panels
/// are in the order of the tree; vertices keep their numbers.
struct PanelTree {
  PanelSurface surface;
  std::vector<PanelCluster> clusters;    ///< parents before their children; the first is the root
  std::vector<std::vector<int>> levels;  ///< clusters by their depth
  std::vector<int> leaves;               ///< in the order of the panels
  std::vector<int> leaf_of_panel;        ///< place in `leaves`
};

/// Leaves hold at most `leaf_size` panels. Depends on nothing else but the surface.
PanelTree makePanelTree(const PanelSurface& surface, int leaf_size);

/// Pairs of clusters that interact by expansions, and pairs of leaves that interact panel by panel.
struct ClusterPairs {
  std::vector<std::vector<int>> far;   ///< of every cluster: the sources its expansion takes
  std::vector<std::vector<int>> near;  ///< of every leaf (its place in `leaves`): other leaves and
                                       ///< itself, ascending
};

/// Every pair of panels is in exactly one far or near pair of clusters. Far pairs have radii of at
/// most `opening` times the distance of their centres, and hold only panels of PairKind::Far.
ClusterPairs pairClusters(const PanelTree& tree, double opening);

}  // namespace ambient
