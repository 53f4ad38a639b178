#include "preprocess/potential_flow/operators/cluster_expansions.h"

#include "preprocess/base/parallel_for.h"

namespace ambient {

using Eigen::Index;
using Eigen::MatrixXf;

void ClusterExpansions::fillShiftToParent(int cluster, MatrixXf& matrix) const {
  const PanelCluster& child = tree_.clusters[cluster];
  const PanelCluster& parent = tree_.clusters[child.parent];
  harmonics_.fillShift((child.centre - parent.centre) / parent.radius, child.radius / parent.radius,
                       matrix);
}

void ClusterExpansions::computeLocals(MatrixXf& multipoles, Index fields, MatrixXf& locals) const {
  const auto block = [&](MatrixXf& m, int c) { return m.middleCols(c * fields, fields); };
  const auto clusters = static_cast<Index>(tree_.clusters.size());
  for (std::size_t level = tree_.levels.size(); level-- > 0;) {
    const std::vector<int>& here = tree_.levels[level];
    parallelFor(threads_, static_cast<Index>(here.size()), [&](Index k) {
      const int c = here[k];
      if (tree_.clusters[c].isLeaf()) return;
      MatrixXf shift;
      block(multipoles, c).setZero();
      for (const int child : tree_.clusters[c].children) {
        fillShiftToParent(child, shift);
        block(multipoles, c).noalias() += shift * block(multipoles, child);
      }
    });
  }
  locals.setZero(harmonics_.count(), fields * clusters);
  parallelFor(threads_, clusters, [&](Index c) {
    MatrixXf transfer;
    const PanelCluster& target = tree_.clusters[c];
    for (const int s : pairs_.far[c]) {
      const PanelCluster& source = tree_.clusters[s];
      harmonics_.fillTransfer(target.centre - source.centre, target.radius, source.radius,
                              transfer);
      block(locals, static_cast<int>(c)).noalias() += transfer * block(multipoles, s);
    }
  });
  for (const std::vector<int>& here : tree_.levels)
    parallelFor(threads_, static_cast<Index>(here.size()), [&](Index k) {
      const int c = here[k];
      if (tree_.clusters[c].parent < 0) return;
      MatrixXf shift;
      fillShiftToParent(c, shift);
      block(locals, c).noalias() += shift.transpose() * block(locals, tree_.clusters[c].parent);
    });
}

}  // namespace ambient
