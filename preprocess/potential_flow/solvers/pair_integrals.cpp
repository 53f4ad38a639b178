#include "preprocess/potential_flow/solvers/pair_integrals.h"

#include <algorithm>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/potential_flow/solvers/block_product.h"
#include "preprocess/potential_flow/surface/panel_pair.h"
#include "preprocess/potential_flow/surface/quadrature_rules.h"

namespace ambient {

using Eigen::Index;
using Eigen::MatrixXf;

PairIntegrals::PairIntegrals(const PanelTree& tree, const ClusterPairs& pairs, int degree,
                             int threads)
    : tree_(tree),
      pairs_(pairs),
      expansions_(tree, pairs, degree, threads),
      threads_(threads),
      panel_harmonics_(expansions_.harmonics().count(), tree.surface.panelCount()),
      offset_(pairs.near.size()) {
  struct Task {
    int t, s;
  };
  std::vector<Task> tasks;
  std::size_t size = 0;
  for (std::size_t t = 0; t < offset_.size(); ++t)
    for (const int s : pairs.near[t]) {
      offset_[t].push_back(size);
      if (s < static_cast<int>(t)) continue;
      size += leaf(static_cast<int>(t)).count * leaf(s).count;
      tasks.push_back({static_cast<int>(t), s});
    }
  near_.resize(size);
  parallelFor(threads, static_cast<Index>(tasks.size()),
              [&](Index k) { fillNear(tasks[k].t, tasks[k].s); });
  parallelFor(threads, static_cast<Index>(offset_.size()),
              [&](Index k) { fillLeafHarmonics(static_cast<int>(k)); });
}

double PairIntegrals::nearBytes(const PanelTree& tree, const ClusterPairs& pairs) {
  double numbers = 0;
  for (std::size_t t = 0; t < pairs.near.size(); ++t)
    for (const int s : pairs.near[t])
      if (s >= static_cast<int>(t))
        numbers += static_cast<double>(tree.clusters[tree.leaves[t]].count) *
                   static_cast<double>(tree.clusters[tree.leaves[s]].count);
  return sizeof(float) * numbers;
}

void PairIntegrals::fillNear(int t, int s) {
  const PanelCluster &rows = leaf(t), &columns = leaf(s);
  float* value = near_.data() + nearOffset(t, s);
  Eigen::ArrayXd far(rows.count);
  for (Index j = 0; j < columns.count; ++j, value += rows.count) {
    const Index source = columns.first + j;
    computeFarPairIntegrals(tree_.surface.arrays, source, rows.first, far);
    const Index upper = t == s ? j + 1 : rows.count;
    for (Index i = 0; i < upper; ++i) {
      const Index target = rows.first + i;
      const bool is_far = classifyPair(tree_.surface, target, source) == PairKind::Far;
      value[i] =
          static_cast<float>(is_far ? far[i] : computePairIntegral(tree_.surface, target, source));
    }
  }
  if (t != s) return;
  Eigen::Map<MatrixXf> own(near_.data() + nearOffset(t, t), rows.count, rows.count);
  own.triangularView<Eigen::StrictlyLower>() = own.transpose();
}

void PairIntegrals::fillLeafHarmonics(int k) {
  const PanelCluster& cluster = leaf(k);
  Eigen::VectorXd at_node(expansions_.harmonics().count()), mean(at_node.size());
  for (Index t = cluster.first; t < cluster.first + cluster.count; ++t) {
    const Panel& panel = tree_.surface.panels[t];
    mean.setZero();
    for (const TriangleNode& node : kTriangleRule6) {
      expansions_.harmonics().evaluateRegular(
          (panel.at(node.barycentric) - cluster.centre) / cluster.radius, at_node);
      mean += node.weight * at_node;
    }
    panel_harmonics_.col(t) = (panel.area * mean).cast<float>();
  }
}

std::size_t PairIntegrals::nearOffset(int t, int s) const {
  const std::vector<int>& near = pairs_.near[t];
  return offset_[t][std::lower_bound(near.begin(), near.end(), s) - near.begin()];
}

PairIntegrals::Block PairIntegrals::nearBlock(int t, int s) const {
  return {near_.data() + nearOffset(t, s), leaf(t).count, leaf(s).count};
}

double PairIntegrals::entry(Index t, Index s) const {
  AMBIENT_ASSERT(t >= 0 && s >= 0 &&
                 std::max(t, s) < static_cast<Index>(tree_.leaf_of_panel.size()));
  if (tree_.leaf_of_panel[t] > tree_.leaf_of_panel[s]) std::swap(t, s);
  const int row = tree_.leaf_of_panel[t], column = tree_.leaf_of_panel[s];
  return nearBlock(row, column)(t - leaf(row).first, s - leaf(column).first);
}

void PairIntegrals::addNear(int t, int s, const FieldRows& x, FieldRows& y) const {
  const Block block = t <= s ? nearBlock(t, s) : nearBlock(s, t);
  const Index stride = block.outerStride();
  const MatrixBlock view = t <= s
                               ? MatrixBlock{block.data(), block.rows(), block.cols(), 1, stride}
                               : MatrixBlock{block.data(), block.cols(), block.rows(), stride, 1};
  addBlockProduct(view, x.row(leaf(s).first).data(), static_cast<int>(x.cols()), y.data());
}

MatrixXf PairIntegrals::apply(const MatrixXf& x) const {
  const Index fields = x.cols(), terms = panel_harmonics_.rows();
  const auto leaves = static_cast<Index>(tree_.leaves.size());
  MatrixXf multipoles(terms, fields * static_cast<Index>(tree_.clusters.size())), locals;
  FieldRows rows = FieldRows::Zero(x.rows(), fields <= kFieldGroup ? kFieldGroup : 3 * kFieldGroup);
  parallelFor(threads_, leaves, [&](Index k) {
    const PanelCluster& c = leaf(static_cast<int>(k));
    multipoles.middleCols(tree_.leaves[k] * fields, fields).noalias() =
        panel_harmonics_.middleCols(c.first, c.count) * x.middleRows(c.first, c.count);
    rows.block(c.first, 0, c.count, fields) = x.middleRows(c.first, c.count);
  });
  expansions_.computeLocals(multipoles, fields, locals);
  MatrixXf y(x.rows(), fields);
  parallelFor(threads_, leaves, [&](Index k) {
    const PanelCluster& c = leaf(static_cast<int>(k));
    FieldRows near = FieldRows::Zero(c.count, rows.cols());
    for (const int s : pairs_.near[k]) addNear(static_cast<int>(k), s, rows, near);
    auto part = y.middleRows(c.first, c.count);
    part.noalias() = panel_harmonics_.middleCols(c.first, c.count).transpose() *
                     locals.middleCols(tree_.leaves[k] * fields, fields);
    part += near.leftCols(fields);
  });
  return y;
}

}  // namespace ambient
