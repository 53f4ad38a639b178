#pragma once

#include <vector>

#include "preprocess/potential_flow/operators/solid_harmonics.h"

namespace ambient {

/// The symmetric matrix of all pair integrals I(t, s) (docs/theory.md eq. (9)) of a tree's panels:
/// near leaves entry by entry in single precision, far clusters as expansions.
class PairIntegrals {
 public:
  PairIntegrals(const PanelTree& tree, const ClusterPairs& pairs, int degree, int threads);

  /// Computes I x for several columns at once, at most 24; the same bits for every number of
  /// threads.
  Eigen::MatrixXf apply(const Eigen::MatrixXf& x) const;

  /// Returns I(t, s). @pre the leaves of both panels are near, as for panels that touch
  double entry(Eigen::Index t, Eigen::Index s) const;

  /// Memory of the entries between near leaves [bytes].
  static double nearBytes(const PanelTree& tree, const ClusterPairs& pairs);

 private:
  using Block = Eigen::Map<const Eigen::MatrixXf>;
  using FieldRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void fillNear(int t, int s);
  void fillLeafHarmonics(int leaf);
  /// Entries between leaves t <= s.
  std::size_t nearOffset(int t, int s) const;
  Block nearBlock(int t, int s) const;
  /// y += I x for the rows of leaf t and the columns of leaf s.
  void addNear(int t, int s, const FieldRows& x, FieldRows& y) const;
  const PanelCluster& leaf(int k) const { return tree_.clusters[tree_.leaves[k]]; }

  const PanelTree& tree_;
  const ClusterPairs& pairs_;
  ClusterExpansions expansions_;
  int threads_;
  Eigen::MatrixXf panel_harmonics_;  ///< a column per panel: integrals of the regular harmonics
  std::vector<std::vector<std::size_t>> offset_;  ///< beside ClusterPairs::near, for t <= s
  std::vector<float> near_;
};

}  // namespace ambient
