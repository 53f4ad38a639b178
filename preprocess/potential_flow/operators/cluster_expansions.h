#pragma once

#include "preprocess/potential_flow/operators/panel_tree.h"
#include "preprocess/potential_flow/operators/solid_harmonics.h"

namespace ambient {

/// Expansions of several fields in the clusters of a tree: what leaves the panels of a cluster
/// (multipoles), and what far clusters cause in it (locals), each about its centre in units of its
/// radius. Blocks of one matrix, (p + 1)^2 rows, per cluster `fields` columns.
class ClusterExpansions {
 public:
  ClusterExpansions(const PanelTree& tree, const ClusterPairs& pairs, int degree, int threads)
      : tree_(tree), pairs_(pairs), harmonics_(degree), threads_(threads) {}

  const SolidHarmonics& harmonics() const { return harmonics_; }

  /// From the multipoles of the leaves, the others not being used, to the locals of the leaves;
  /// docs/theory.md eq. (33). The same bits for every number of threads.
  void computeLocals(Eigen::MatrixXf& multipoles, Eigen::Index fields,
                     Eigen::MatrixXf& locals) const;

 private:
  void fillShiftToParent(int cluster, Eigen::MatrixXf& matrix) const;

  const PanelTree& tree_;
  const ClusterPairs& pairs_;
  SolidHarmonics harmonics_;
  int threads_;
};

}  // namespace ambient
