#include "preprocess/potential_flow/operators/tree_double_layer.h"

#include <algorithm>

#include "bullet_ambient/base/pi.h"
#include "preprocess/base/parallel_for.h"
#include "preprocess/potential_flow/operators/far_moments.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using Matrix36 = Eigen::Matrix<double, 3, 6>;
using RowVector6 = Eigen::Matrix<double, 1, 6>;

constexpr Index kFields = 7;  // the six jumps and a jump of 1, which makes the solid angle

/// Dipoles mu n of a leaf's panels.
Eigen::MatrixXd leafMultipoles(const PanelTree& tree, const PanelCluster& leaf,
                               const std::vector<PanelJump>& jumps,
                               const SolidHarmonics& harmonics) {
  Eigen::MatrixXd multipoles = Eigen::MatrixXd::Zero(harmonics.count(), kFields);
  VectorXd slope(harmonics.count());
  for (Index s = leaf.first; s < leaf.first + leaf.count; ++s) {
    const Panel& panel = tree.surface.panels[s];
    for (const TriangleNode& node : kTriangleRule6) {
      const Eigen::Map<const Eigen::Vector3d> hat(node.barycentric.data());
      harmonics.evaluateSlope((panel.at(node.barycentric) - leaf.centre) / leaf.radius,
                              panel.normal / leaf.radius, slope);
      slope *= node.weight * panel.area;
      multipoles.leftCols<6>() += slope * (hat.transpose() * jumps[s].corner);
      multipoles.col(6) += slope;
    }
  }
  return multipoles;
}

/// Returns the moments of the potential that far clusters cause on panel t of a leaf.
Matrix36 farClusterMoments(const Panel& panel, const PanelCluster& leaf, const PanelJump& jump,
                           const Eigen::MatrixXd& local, const SolidHarmonics& harmonics) {
  NodePotentials<6> potentials(panel, kTriangleRule6);
  VectorXd regular(harmonics.count());
  for (std::size_t k = 0; k < kTriangleRule6.size(); ++k) {
    harmonics.evaluateRegular((potentials.node(k) - leaf.centre) / leaf.radius, regular);
    const Eigen::Matrix<double, 1, kFields> value = regular.transpose() * local;
    potentials.add(k, value.head<6>(), value[6]);
  }
  return potentials.moments(panel, jump.corner);
}

/// The panels of near leaves that are not far from panel t.
std::vector<NearPanels::Entry> listNear(const PanelSurface& surface, Index t,
                                        const std::vector<PanelRange>& sources) {
  std::vector<NearPanels::Entry> near;
  for (const PanelRange& range : sources)
    for (Index s = range.first; s < range.first + range.count; ++s) {
      const PairKind kind = classifyPair(surface, t, s);
      if (kind != PairKind::Far) near.push_back({static_cast<int>(s), kind, 0});
    }
  return near;
}

void addNearLeaves(const PanelSurface& surface, const PanelCluster& leaf,
                   const std::vector<PanelRange>& sources, const std::vector<PanelJump>& jumps,
                   const FarMoments& far, PanelMoments& moments) {
  constexpr Index kAtOnce = FarMoments::kTargetsAtOnce;
  const Index end = leaf.first + leaf.count;
  for (Index first = leaf.first; first < end; first += kAtOnce) {
    const Index count = std::min(kAtOnce, end - first);
    std::vector<std::vector<NearPanels::Entry>> near;
    for (Index t = first; t < first + count; ++t) near.push_back(listNear(surface, t, sources));
    far.add(sources, {first, count}, near.data(), moments);
    for (Index k = 0; k < count; ++k)
      moments[first + k] += computeNearMoments(surface, near[k], jumps, first + k);
  }
}

}  // namespace

PanelMoments computeExteriorMoments(const PanelTree& tree, const ClusterPairs& pairs, int degree,
                                    const Eigen::Matrix<double, Eigen::Dynamic, 6>& jump,
                                    int threads) {
  const PanelSurface& surface = tree.surface;
  const ClusterExpansions expansions(tree, pairs, degree, threads);
  const std::vector<PanelJump> jumps = makePanelJumps(surface, jump);
  const FarMoments far(surface, jumps);
  const auto leaves = static_cast<Index>(tree.leaves.size());
  const auto leaf = [&](Index k) -> const PanelCluster& { return tree.clusters[tree.leaves[k]]; };
  MatrixXf multipoles(expansions.harmonics().count(),
                      kFields * static_cast<Index>(tree.clusters.size()));
  parallelFor(threads, leaves, [&](Index k) {
    multipoles.middleCols(tree.leaves[k] * kFields, kFields) =
        leafMultipoles(tree, leaf(k), jumps, expansions.harmonics()).cast<float>();
  });
  MatrixXf locals;
  expansions.computeLocals(multipoles, kFields, locals);
  PanelMoments moments(surface.panelCount(), Matrix36::Zero());
  parallelFor(threads, leaves, [&](Index k) {
    std::vector<PanelRange> sources;
    for (const int s : pairs.near[k]) sources.push_back({leaf(s).first, leaf(s).count});
    addNearLeaves(surface, leaf(k), sources, jumps, far, moments);
    const Eigen::MatrixXd local =
        locals.middleCols(tree.leaves[k] * kFields, kFields).cast<double>();
    for (Index t = leaf(k).first; t < leaf(k).first + leaf(k).count; ++t) {
      moments[t] +=
          farClusterMoments(surface.panels[t], leaf(k), jumps[t], local, expansions.harmonics());
      moments[t] /= 4 * kPi;
    }
  });
  return moments;
}

}  // namespace ambient
