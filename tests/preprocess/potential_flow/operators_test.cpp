#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/near_moments.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/potential_flow/solvers/block_product.h"
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

/// Fixed values without structure.
MatrixX6 someValues(Index rows) {
  MatrixX6 values(rows, 6);
  for (Index i = 0; i < values.size(); ++i)
    values.data()[i] = std::sin(static_cast<double>(i * i + 1));
  return values;
}

double hat(const Panel& p, int a, const Vector3d& x) {
  return 1 + p.hatGradient(a).dot(x - p.corner[a]);
}

/// int_T f(x) int_S h_b(y) dG/dn_y; outer integral by fine subdivision.
template <typename Function>
double layerIntegral(const Panel& t, const Panel& s, int b, const Function& f) {
  return reference::integrateOverTriangle(
             t.corner, [&](const Vector3d& x) { return f(x) * computeDoubleLayer(s, x)[b]; }, 0.2) /
         (4 * kPi);
}

Eigen::Matrix<double, 3, 6> referenceMoments(const PanelSurface& surface, const MatrixX6& jump,
                                             Index t) {
  const Panel& p = surface.panels[t];
  Eigen::Matrix<double, 3, 6> moments = Eigen::Matrix<double, 3, 6>::Zero();
  for (Index s = 0; s < surface.panelCount(); ++s)
    for (int a = 0; a < 3 && s != t; ++a)
      for (int b = 0; b < 3; ++b) {
        const Panel& q = surface.panels[s];
        moments.row(a) += layerIntegral(p, q, b, [&](const Vector3d& x) { return hat(p, a, x); }) *
                          jump.row(surface.triangles(b, s));
        for (int c = 0; c < 3; ++c)
          moments.row(a) -=
              layerIntegral(p, q, b,
                            [&](const Vector3d& x) { return hat(p, a, x) * hat(p, c, x); }) *
              jump.row(surface.triangles(c, t));
      }
  return moments;
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

TEST(Hypersingular, AnnihilatesTheConstantsOfEachComponent) {
  const PanelSurface surface = twoTetrahedra();
  ASSERT_EQ(surface.component_count, 2);
  const Eigen::MatrixXd W = fullHypersingular(surface);
  for (int c = 0; c < 2; ++c) {
    Eigen::VectorXd m(surface.vertexCount());
    for (Index v = 0; v < m.size(); ++v) m[v] = surface.component[v] == c;
    EXPECT_LT((W * m).norm(), 1e-14 * W.norm());
  }
}

TEST(Hypersingular, IsPositiveDefiniteButForTheConstants) {
  const PanelSurface surface = makePanelSurface(makeBoxMesh({1, 0.5, 0.01}, 300), false);
  const Eigen::VectorXd values = test::symmetricEigenvalues(fullHypersingular(surface));
  const double largest = values[values.size() - 1];
  EXPECT_NEAR(values[0], 0, 1e-14 * largest);
  EXPECT_GT(values[1], 1e-5 * largest);
}

TEST(NormalVelocity, OfAClosedSurfaceSumsToZeroAndMeasuresTheVolume) {
  const PanelSurface surface = makePanelSurface(moved(unitTetrahedron(), {3, 2, 1}), false);
  const MatrixX6 B = assembleNormalVelocity(surface, numberUnknowns(surface));
  EXPECT_LT(B.colwise().sum().norm(), 1e-15);
  // int z_i n_j = volume delta_ij; hat functions contain the linear function z exactly.
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
  for (Index t = 0; t < surface.panelCount(); ++t)
    for (int a = 0; a < 3; ++a) {
      const Panel& p = surface.panels[t];
      moment += p.corner[a] * p.normal.transpose() * (p.area / 3);
    }
  EXPECT_LT((moment - surface.volume * Eigen::Matrix3d::Identity()).norm(), 1e-15);
}

TEST(NormalVelocity, IsExactForRotations) {
  const PanelSurface surface = makePanelSurface(moved(unitTetrahedron(), {3, 2, 1}), false);
  const MatrixX6 B = assembleNormalVelocity(surface, numberUnknowns(surface));
  for (int axis = 0; axis < 3; ++axis) {
    double reference = 0;
    for (Index t = 0; t < surface.panelCount(); ++t)
      for (int a = 0; a < 3; ++a) {
        if (surface.triangles(a, t) != 2) continue;
        const Panel& p = surface.panels[t];
        reference += reference::integrateOverTriangle(p.corner, [&](const Vector3d& z) {
          const double hat = 1 + p.hatGradient(a).dot(z - p.corner[a]);
          return hat * p.normal.dot(Vector3d::Unit(axis).cross(z));
        });
      }
    EXPECT_NEAR(B(2, axis), reference, 1e-10);
  }
}

PanelMoments momentsOf(const PanelSurface& surface, const MatrixX6& jump) {
  return computeExteriorMoments(surface, findNearPanels(surface, 1), jump, 1);
}

TEST(ExteriorMoments, EqualReferenceIntegralsOverBothPanels) {
  const PanelSurface surface = twoTetrahedra();
  const MatrixX6 jump = someValues(surface.vertexCount());
  const PanelMoments moments = momentsOf(surface, jump);
  for (Index t : {1, 6}) {
    const auto reference = referenceMoments(surface, jump, t);
    // Quadrature of 16 points next to edges; measured 1e-3.
    EXPECT_LT((moments[t] - reference).norm(), 1.5e-3 * reference.norm()) << t;
  }
}

TEST(ExteriorMoments, OfDistantPanelsEqualReferenceIntegrals) {
  // Jumps on the other body only: no near pairs hide the far field's error. The distance is the
  // least for far pairs, and most moments cancel. Measured 5.7e-3.
  const PanelSurface surface = twoTetrahedra({3.5, 3, -2.5});
  for (Index s = 4; s < 8; ++s) ASSERT_EQ(classifyPair(surface, 1, s), PairKind::Far);
  MatrixX6 jump = someValues(surface.vertexCount());
  jump.topRows<4>().setZero();
  const auto reference = referenceMoments(surface, jump, 1);
  EXPECT_LT((momentsOf(surface, jump)[1] - reference).norm(), 8e-3 * reference.norm());
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

TEST(VertexProjection, ReturnsPiecewiseLinearFunctionsUnchanged) {
  const PanelSurface surface = makePanelSurface(makeConeMesh(1, 2, 200), false);
  const MatrixX6 values = someValues(surface.vertexCount());
  PanelMoments moments(surface.panelCount());
  for (Index t = 0; t < surface.panelCount(); ++t) {
    const double third = surface.panels[t].area / 12;
    for (int a = 0; a < 3; ++a) {
      moments[t].row(a) = third * values.row(surface.triangles(a, t));
      for (int b = 0; b < 3; ++b) moments[t].row(a) += third * values.row(surface.triangles(b, t));
    }
  }
  EXPECT_LT((projectOnVertices(surface, moments) - values).cwiseAbs().maxCoeff(), 1e-13);
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

}  // namespace
}  // namespace ambient
