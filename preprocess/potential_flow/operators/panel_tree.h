#pragma once

#include <vector>

#include "preprocess/potential_flow/surface/panel_surface.h"

namespace ambient {

/// Neighbouring panels: `count` panels from number `first` on.
struct PanelCluster {
  Eigen::Index first = 0, count = 0;
  int parent = -1;                        ///< parent cluster; -1: this is the root
  std::array<int, 2> children{{-1, -1}};  ///< child clusters; -1: this is a leaf
  Eigen::Vector3d centre;                 ///< centre of the box around its corners
  double radius = 0;                      ///< largest distance of a corner from the centre
  double panel_radius = 0;                ///< largest radius of its panels

  bool isLeaf() const { return children[0] < 0; }
};

/// Binary tree of clusters, halved across their longest side. The surface is a copy whose panels
/// are in the order of the tree; vertices keep their numbers.
struct PanelTree {
  PanelSurface surface;
  std::vector<PanelCluster> clusters;    ///< parents before their children; the first is the root
  std::vector<std::vector<int>> levels;  ///< numbers of clusters by depth
  std::vector<int> leaves;               ///< in the order of the panels
  std::vector<int> leaf_of_panel;        ///< place in `leaves`
};

/// Makes the tree; leaves hold at most `leaf_size` panels. Depends on nothing but the surface.
PanelTree makePanelTree(const PanelSurface& surface, int leaf_size);

/// Pairs of clusters that interact by expansions, and pairs of leaves that interact panel by panel.
struct ClusterPairs {
  std::vector<std::vector<int>> far;  ///< for every cluster: source clusters of its local expansion
  std::vector<std::vector<int>>
      near;  ///< for every leaf (index in `leaves`): near leaves and itself, ascending
};

/// Finds pairs of clusters such that every pair of panels is in exactly one far or near pair. In a
/// far pair, radii are at most `opening` times the distance of the centres, and all panels are of
/// PairKind::Far.
ClusterPairs pairClusters(const PanelTree& tree, double opening);

}  // namespace ambient
