#pragma once

#include "preprocess/potential_flow/operators/panel_tree.h"
#include "preprocess/potential_flow/operators/solid_harmonics.h"

namespace ambient {

/// Expansions of several fields in the clusters of a tree: multipoles (fields of the panels of a
/// cluster, seen from far) and locals (fields of far clusters, seen in the cluster), each about the
/// centre of the cluster in units of its radius. One matrix has all: (p + 1)^2 rows, and `fields`
/// columns per cluster.
class ClusterExpansions {
 public:
  ClusterExpansions(const PanelTree& tree, const ClusterPairs& pairs, int degree, int threads)
      : tree_(tree), pairs_(pairs), harmonics_(degree), threads_(threads) {}

  const SolidHarmonics& harmonics() const { return harmonics_; }

  /// Computes the locals of the leaves from the multipoles of the leaves; docs/theory.md eq. (33).
  /// Overwrites the other multipoles. The same bits for every number of threads.
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
