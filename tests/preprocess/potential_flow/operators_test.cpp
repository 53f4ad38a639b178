#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/near_moments.h"
#include "preprocess/potential_flow/operators/panel_tree.h"
#include "preprocess/potential_flow/operators/solid_harmonics.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/potential_flow/solvers/block_product.h"
#include "preprocess/potential_flow/solvers/flow_solver.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/reference/triangle_potentials.h"
#include "tests/support/matrices.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;

/// Two skew tetrahedra, triangles 0 to 3 and 4 to 7.
PanelSurface twoTetrahedra(const Vector3d& distance = {2.5, 1, -0.5}) {
  const TriangleMesh one = unitTetrahedron();
  const TriangleMesh other = rotated(one, someRotation());
  return makePanelSurface(joined(one, moved(scaled(other, 0.7), distance)), false);
}

Eigen::MatrixXd fullHypersingular(const PanelSurface& surface) {
  const Eigen::MatrixXd W =
      assembleHypersingular(surface, numberUnknowns(surface), findNearPanels(surface, 1), 1);
  return W.selfadjointView<Eigen::Lower>();
}

TEST(Hypersingular, EqualsTheSumOfReferencePairIntegrals) {
  const PanelSurface surface = twoTetrahedra();
  Eigen::MatrixXd reference = Eigen::MatrixXd::Zero(8, 8);
  for (Index t = 0; t < 8; ++t)
    for (Index s = 0; s < 8; ++s) {
      const Panel &p = surface.panels[t], &q = surface.panels[s];
      const double integral = reference::pairIntegral(p.corner, q.corner) / (4 * kPi);
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          reference(surface.triangles(a, t), surface.triangles(b, s)) +=
              p.normal.cross(p.hatGradient(a)).dot(q.normal.cross(q.hatGradient(b))) * integral;
    }
  // Error of the pairs' quadrature; measured 6.5e-6.
  EXPECT_LT((fullHypersingular(surface) - reference).norm(), 1e-5 * reference.norm());
}

TEST(Hypersingular, IsPositiveDefiniteButForTheConstants) {
  const PanelSurface surface = makePanelSurface(makeBoxMesh({1, 0.5, 0.01}, 300), false);
  const Eigen::VectorXd values = test::symmetricEigenvalues(fullHypersingular(surface));
  const double largest = values[values.size() - 1];
  EXPECT_NEAR(values[0], 0, 1e-14 * largest);
  EXPECT_GT(values[1], 1e-5 * largest);
}

PanelMoments momentsOf(const PanelSurface& surface, const MatrixX6& jump) {
  return computeExteriorMoments(surface, findNearPanels(surface, 1), jump, 1);
}

TEST(ExteriorMoments, OfAConstantJumpVanish) {
  const PanelSurface surface = makePanelSurface(makeEllipsoidMesh({1, 0.6, 0.3}, 500), false);
  const MatrixX6 jump = MatrixX6::Constant(surface.vertexCount(), 6, 1.7);
  for (const auto& moment : momentsOf(surface, jump)) EXPECT_LT(moment.norm(), 1e-14);
}

TEST(ExteriorMoments, OfALinearJumpOnTheSphereAreThoseOfAThirdOfIt) {
  // Green's formula for the potential z inside. Outside, its double layer equals the single layer
  // of n: n / 3 on the unit sphere.
  const PanelSurface surface = makePanelSurface(makeEllipsoidMesh({1, 1, 1}, 1280), false);
  MatrixX6 jump = MatrixX6::Zero(surface.vertexCount(), 6);
  for (Index t = 0; t < surface.panelCount(); ++t)
    for (int a = 0; a < 3; ++a)
      jump.row(surface.triangles(a, t)).head<3>() = surface.panels[t].corner[a].transpose();
  const MatrixX6 potential = projectOnVertices(surface, momentsOf(surface, jump));
  // Error of facets instead of the sphere; measured 5e-4.
  EXPECT_LT((potential.leftCols<3>() - jump.leftCols<3>() / 3).cwiseAbs().maxCoeff(), 1e-3);
}

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

TEST(BlockProduct, AddsTheBlockAndItsTransposeForAllFieldsAndSizes) {
  for (const int rows : {1, 3, 8, 13})
    for (const int columns : {1, 5, 16})
      for (const int fields : {8, 24}) {
        // Small integers make exact sums.
        const auto numbers = [](Eigen::Index i, Eigen::Index j) {
          return static_cast<float>((7 * i + 5 * j) % 11 - 5);
        };
        const Eigen::MatrixXf block = Eigen::MatrixXf::NullaryExpr(rows, columns, numbers);
        const Rows x = Rows::NullaryExpr(columns, fields, numbers);
        const Rows z = Rows::NullaryExpr(rows, fields, numbers);
        Rows y = Rows::Ones(rows, fields), w = Rows::Ones(columns, fields);
        addBlockProduct({block.data(), rows, columns, 1, rows}, x.data(), fields, y.data());
        addBlockProduct({block.data(), columns, rows, rows, 1}, z.data(), fields, w.data());
        EXPECT_EQ(y, Rows((block * x).array() + 1)) << rows << " " << columns << " " << fields;
        EXPECT_EQ(w, Rows((block.transpose() * z).array() + 1));
      }
}

constexpr double kOpening = 0.7;

PanelSurface twoBodies() {
  const TriangleMesh ball = scaled(makeEllipsoidMesh({1, 0.7, 0.5}, 320), 0.6);
  return makePanelSurface(joined(makeBoxMesh({1, 1, 0.05}, 432), moved(ball, {0.3, 0.2, 1})),
                          false);
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

}  // namespace
}  // namespace ambient
