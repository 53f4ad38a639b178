#include "preprocess/potential_flow/operators/panel_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/solid_harmonics.h"
#include "preprocess/potential_flow/solvers/pair_integrals.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient {
namespace {

using Eigen::Index;
using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

constexpr double kOpening = 0.7;

PanelSurface twoBodies() {
  const TriangleMesh ball = scaled(makeEllipsoidMesh({1, 0.7, 0.5}, 320), 0.6);
  return makePanelSurface(joined(makeBoxMesh({1, 1, 0.05}, 432), moved(ball, {0.3, 0.2, 1})),
                          false);
}

TEST(PanelTree, HoldsEveryPanelOnceInItsOrder) {
  const PanelSurface surface = twoBodies();
  const PanelTree tree = makePanelTree(surface, 20);
  ASSERT_EQ(tree.surface.panelCount(), surface.panelCount());
  Eigen::VectorXi seen = Eigen::VectorXi::Zero(surface.panelCount());
  for (Index t = 0; t < surface.panelCount(); ++t)
    for (Index s = 0; s < surface.panelCount(); ++s)
      seen[s] += tree.surface.triangles.col(t) == surface.triangles.col(s) ? 1 : 0;
  EXPECT_TRUE((seen.array() == 1).all());
  Index next = 0;
  for (const int leaf : tree.leaves) {
    const PanelCluster& cluster = tree.clusters[leaf];
    EXPECT_EQ(cluster.first, next);
    EXPECT_LE(cluster.count, 20);
    next += cluster.count;
    for (Index t = cluster.first; t < next; ++t) {
      EXPECT_EQ(tree.leaves[tree.leaf_of_panel[t]], leaf);
      EXPECT_EQ(tree.surface.arrays.area[t], tree.surface.panels[t].area);
      for (const Eigen::Vector3d& corner : tree.surface.panels[t].corner)
        EXPECT_LE((corner - cluster.centre).norm(), cluster.radius * (1 + 1e-14));
    }
  }
  EXPECT_EQ(next, surface.panelCount());
}

TEST(PanelTree, EveryPairOfPanelsIsInOnePairOfClusters) {
  const PanelTree tree = makePanelTree(twoBodies(), 8);
  const ClusterPairs pairs = pairClusters(tree, kOpening);
  const Index panels = tree.surface.panelCount();
  Eigen::MatrixXi seen = Eigen::MatrixXi::Zero(panels, panels);
  const auto block = [&](int t, int s) {
    const PanelCluster &rows = tree.clusters[t], &columns = tree.clusters[s];
    return seen.block(rows.first, columns.first, rows.count, columns.count);
  };
  int far = 0;
  for (std::size_t t = 0; t < pairs.far.size(); ++t)
    for (const int s : pairs.far[t]) {
      block(static_cast<int>(t), s).array() += 1;
      ++far;
    }
  ASSERT_GT(far, 100);
  for (Index t = 0; t < panels; ++t)
    for (Index s = 0; s < panels; ++s)
      EXPECT_TRUE(seen(t, s) == 0 || classifyPair(tree.surface, t, s) == PairKind::Far);
  for (std::size_t t = 0; t < pairs.near.size(); ++t)
    for (const int s : pairs.near[t]) block(tree.leaves[t], tree.leaves[s]).array() += 1;
  EXPECT_TRUE((seen.array() == 1).all());
}

TEST(PairIntegrals, TimesAVectorAreTheSumOverAllPairs) {
  const PanelTree tree = makePanelTree(twoBodies(), 16);
  const ClusterPairs pairs = pairClusters(tree, kOpening);
  const Index panels = tree.surface.panelCount();
  const PairIntegrals integrals(tree, pairs, 5, 2);
  Eigen::MatrixXf x(panels, 2);
  for (Index t = 0; t < panels; ++t)
    x.row(t) << static_cast<float>(std::sin(3 * t)), 1 + 0.1F * static_cast<float>(std::cos(t));
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(panels, 2);
  for (Index t = 0; t < panels; ++t)
    for (Index s = 0; s < panels; ++s)
      expected.row(t) += computePairIntegral(tree.surface, std::min(t, s), std::max(t, s)) *
                         x.row(s).cast<double>();
  const Eigen::MatrixXd product = integrals.apply(x).cast<double>();
  for (int k = 0; k < 2; ++k)
    EXPECT_LT((product - expected).col(k).norm(), 1e-5 * expected.col(k).norm()) << k;
  EXPECT_NEAR(integrals.entry(7, 7), computePairIntegral(tree.surface, 7, 7), 1e-7);
}

TEST(TreeDoubleLayer, HasTheMomentsOfAllPairs) {
  const PanelTree tree = makePanelTree(twoBodies(), 16);
  MatrixX6 jump(tree.surface.vertexCount(), 6);
  for (Index i = 0; i < jump.size(); ++i)
    jump.data()[i] = std::sin(0.01 * static_cast<double>(i)) + 0.5;
  const PanelMoments expected =
      computeExteriorMoments(tree.surface, findNearPanels(tree.surface, 2), jump, 2);
  const PanelMoments moments =
      computeExteriorMoments(tree, pairClusters(tree, kOpening), 5, jump, 2);
  double error = 0, square = 0;
  for (std::size_t t = 0; t < moments.size(); ++t) {
    error += (moments[t] - expected[t]).squaredNorm();
    square += expected[t].squaredNorm();
  }
  EXPECT_LT(std::sqrt(error / square), 1e-4);
}

using Eigen::MatrixXf;
using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd regularAt(const SolidHarmonics& harmonics, const Vector3d& a) {
  VectorXd values(harmonics.count());
  harmonics.evaluateRegular(a, values);
  return values;
}

TEST(SolidHarmonics, ExpandTheInverseDistance) {
  const Vector3d source_centre(0.3, 0.2, -0.1), target_centre(2.3, 1.2, 0.7);
  const double source_scale = 0.4, target_scale = 0.5;
  const Vector3d offset = target_centre - source_centre;
  for (int degree = 1; degree <= 8; ++degree) {
    const SolidHarmonics harmonics(degree);
    MatrixXf transfer;
    harmonics.fillTransfer(offset, target_scale, source_scale, transfer);
    for (int k = 0; k < 20; ++k) {
      const Vector3d a = Vector3d(std::sin(k), std::sin(3 * k + 1), std::cos(2 * k)).normalized();
      const Vector3d b = Vector3d(std::cos(5 * k), std::sin(k + 2), std::sin(7 * k)).normalized();
      const double value =
          regularAt(harmonics, a).transpose() * transfer.cast<double>() * regularAt(harmonics, b);
      const double distance = (offset + target_scale * a - source_scale * b).norm();
      // Bound of the first omitted term; then single precision.
      const double ratio = (target_scale + source_scale) / offset.norm();
      EXPECT_LT(std::abs(value * distance - 1), 2 * std::pow(ratio, degree + 1) + 1e-6)
          << degree << " " << k;
    }
  }
}

TEST(SolidHarmonics, ShiftsAreExact) {
  const SolidHarmonics harmonics(5);
  const Vector3d from(0.2, -0.1, 0.3), to(0.5, 0.4, -0.2), y(0.1, 0.25, 0.15);
  const double from_scale = 0.5, to_scale = 1.3;
  MatrixXf shift;
  harmonics.fillShift((from - to) / to_scale, from_scale / to_scale, shift);
  const VectorXd shifted = shift.cast<double>() * regularAt(harmonics, (y - from) / from_scale);
  const VectorXd expected = regularAt(harmonics, (y - to) / to_scale);
  // Single precision.
  EXPECT_LT((shifted - expected).norm(), 2e-7 * expected.norm());
}

TEST(SolidHarmonics, SlopeIsTheDerivative) {
  const SolidHarmonics harmonics(5);
  const Vector3d a(0.4, -0.3, 0.6), direction(0.2, 1.1, -0.7);
  VectorXd slope(harmonics.count());
  harmonics.evaluateSlope(a, direction, slope);
  const double h = 1e-4;
  const VectorXd difference =
      (regularAt(harmonics, a + h * direction) - regularAt(harmonics, a - h * direction)) / (2 * h);
  EXPECT_LT((slope - difference).norm(), 1e-7 * slope.norm());
}

}  // namespace
}  // namespace ambient
