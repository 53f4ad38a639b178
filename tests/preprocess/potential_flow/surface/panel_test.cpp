#include "preprocess/potential_flow/surface/panel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/potential_flow/surface/panel_pair.h"
#include "preprocess/potential_flow/surface/panel_views.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"
#include "tests/reference/triangle_potentials.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

constexpr double kFineStep = 0.06;

Panel skewPanel() { return makePanel({0.3, -0.2, 0.1}, {1.4, 0.1, 0.4}, {0.2, 0.9, -0.3}); }

/// Points above, below, far, close, in the plane, above an edge's line, above a corner.
std::vector<Vector3d> viewPoints(const Panel& p) {
  return {p.centroid + 0.7 * p.normal,
          p.centroid - 0.02 * p.normal,
          Vector3d(3, -2, 1),
          p.corner[1] + 0.05 * p.normal,
          p.corner[0] - 0.4 * p.edge[0],
          p.centroid + 2 * p.edge[2],
          p.corner[2] + 0.3 * p.edge[2] + 0.1 * p.normal};
}

TEST(Panel, HasTheGeometryOfItsTriangle) {
  const Panel p = makePanel({0, 0, 0}, {3, 0, 0}, {0, 4, 0});
  EXPECT_DOUBLE_EQ(p.area, 6);
  EXPECT_EQ(p.normal, Vector3d::UnitZ());
  EXPECT_DOUBLE_EQ(p.edge_length[1], 5);
  EXPECT_LT((p.edge_normal[1] - Vector3d(0.8, 0.6, 0)).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(p.radius, (p.corner[2] - p.centroid).norm());
}

TEST(Panel, HatFunctionsAreOneAtTheirCornerAndZeroAtTheOthers) {
  const Panel p = skewPanel();
  for (int a = 0; a < 3; ++a) {
    const Vector3d opposite = p.corner[(a + 1) % 3];
    EXPECT_NEAR(p.hatGradient(a).dot(p.corner[a] - opposite), 1, 1e-14);
    EXPECT_NEAR(p.hatGradient(a).dot(p.edge[(a + 1) % 3]), 0, 1e-14);
    EXPECT_NEAR(p.hatGradient(a).dot(p.normal), 0, 1e-14);
    EXPECT_LT((p.normal.cross(p.hatGradient(a)) + p.hatCurl(a)).norm(), 1e-14);
  }
}

/// A panel and sixteen points at any distance from it, the last ones in its plane, on a corner and
/// on an edge's line.
struct SeenPanel {
  PanelNumbers panel;
  PanelPoints points;

  SeenPanel() {
    const Panel p = skewPanel();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<Vector3d> at;
    for (int i = 0; i < kMostPanelPoints - 3; ++i)
      at.push_back(p.centroid + std::pow(10, 2 * number(random)) *
                                    Vector3d(number(random), number(random), number(random)));
    at.insert(at.end(), {p.centroid, p.corner[1], p.corner[0] - 2 * p.edge[0]});
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < at.size(); ++i) points.at[axis][i] = at[i][axis];
      for (int k = 0; k < 3; ++k) {
        panel.corner[k][axis] = p.corner[k][axis];
        panel.edge_normal[k][axis] = p.edge_normal[k][axis];
        panel.edge_length[k] = p.edge_length[k];
      }
      panel.normal[axis] = p.normal[axis];
    }
    panel.area = p.area;
  }
  Vector3d point(int i) const { return {points.at[0][i], points.at[1][i], points.at[2][i]}; }
  Vector3d corner(int k) const { return Vector3d(panel.corner[k]); }
};

double computeNewtonPotential(const Panel& panel, const Vector3d& x) {
  double potential = 0;
  computeNewtonPotentials(panel, &x, 1, &potential);
  return potential;
}

/// int h_b n.(x - y)/r^3 dy of the three hat functions; their sum is the solid angle.
Vector3d computeDoubleLayer(const Panel& panel, const Vector3d& x) {
  const CornerJumps hats{{1}, {0, 1}, {0, 0, 1}};
  PanelPoints points;
  for (int axis = 0; axis < 3; ++axis)
    std::fill(std::begin(points.at[axis]), std::end(points.at[axis]), x[axis]);
  PanelPotentials potentials{};
  kAddDoubleLayer.fastest()(numbersOf(panel), hats, points, kMostPanelPoints, potentials);
  return {potentials.at[0][0], potentials.at[1][0], potentials.at[2][0]};
}

/// Jumps on the panel.
struct JumpsOnPanel {
  CornerJumps at;

  JumpsOnPanel() {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> number(-1, 1);
    for (auto& corner : at) {
      for (double& value : corner) value = number(random);
      corner[6] = 1;
    }
  }
};

/// Calls a kernel in each instruction set, and compares the bytes of what it writes.
template <class Result, class Pointer, class Call>
void expectSameBits(const Kernels<Pointer>& kernels, const Call& call) {
  for (const int count : {8, 16}) {
    Result baseline{}, other{};
    call(kernels.baseline, count, baseline);
    for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
      other = {};
      if (!kernels.of(set)) continue;
      call(kernels.of(set), count, other);
      EXPECT_EQ(std::memcmp(&baseline, &other, sizeof other), 0);
    }
  }
}

TEST(PanelViews, EveryInstructionSetGivesTheSameBits) {
  const SeenPanel seen;
  const JumpsOnPanel jumps;
  const PanelNodes nodes = nodesOf(skewPanel());
  const auto see = [&](auto kernel, int count, auto& result) {
    kernel(seen.panel, seen.points, count, result);
  };
  expectSameBits<PanelViews>(kViewPanel, see);
  expectSameBits<PanelTensors>(kViewStokeslets, see);
  expectSameBits<PanelPotentials>(kAddDoubleLayer, [&](auto kernel, int count, auto& result) {
    kernel(seen.panel, jumps.at, seen.points, count, result);
  });
  expectSameBits<PanelPotentials>(kAddPointDipoles, [&](auto kernel, int count, auto& result) {
    kernel(seen.panel, nodes, jumps.at, seen.points, count, result);
  });
  const PanelNodes others = nodesOf(makePanel({3, 0, 1}, {4, 0.5, 0}, {3.3, 0.8, -0.2}));
  expectSameBits<double>(kMeanInverseDistance,
                         [&](auto kernel, int, double& result) { result = kernel(nodes, others); });
}

TEST(PanelViews, AddDoubleLayersOfJumps) {
  const SeenPanel seen;
  const JumpsOnPanel jumps;
  PanelPotentials exact{}, by_points{};
  kAddDoubleLayer.fastest()(seen.panel, jumps.at, seen.points, kMostPanelPoints, exact);
  const Panel panel = skewPanel();
  kAddPointDipoles.fastest()(seen.panel, nodesOf(panel), jumps.at, seen.points, kMostPanelPoints,
                             by_points);
  int far = 0;
  for (int i = 0; i < kMostPanelPoints; ++i) {
    const Vector3d weights = computeDoubleLayer(panel, seen.point(i));
    const bool is_far = (seen.point(i) - panel.centroid).norm() > 6 * panel.radius;
    far += is_far ? 1 : 0;
    for (int field = 0; field < 7; ++field) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) sum += weights[k] * jumps.at[k][field];
      EXPECT_NEAR(exact.at[field][i], sum, 1e-13 * (1 + weights.norm())) << i;
      if (!is_far) continue;
      EXPECT_NEAR(by_points.at[field][i], sum, 1e-4 * weights.cwiseAbs().sum()) << i;
    }
  }
  EXPECT_GT(far, 2);
}

TEST(PanelViews, HaveLogarithmsAndAnglesToRounding) {
  const SeenPanel seen;
  PanelViews views;
  viewPanelBaseline(seen.panel, seen.points, kMostPanelPoints, views);
  for (int i = 0; i < kMostPanelPoints; ++i) {
    Vector3d d[3];
    double r[3];
    for (int k = 0; k < 3; ++k) {
      d[k] = seen.corner(k) - seen.point(i);
      r[k] = d[k].norm();
    }
    for (int k = 0; k < 3; ++k) {
      const double sum = r[k] + r[(k + 1) % 3], length = seen.panel.edge_length[k];
      const double exact =
          sum > length ? portable::log((sum + length) / (sum - length)) : 0;  // 0.9 ulp
      EXPECT_NEAR(views.edge_potential[k][i], exact, 1e-15 * (1 + exact) * (1 + r[0] / length))
          << i;
    }
    const double across = -2 * seen.panel.area * d[0].dot(Vector3d(seen.panel.normal));
    const double along =
        r[0] * r[1] * r[2] + d[0].dot(d[1]) * r[2] + d[1].dot(d[2]) * r[0] + d[2].dot(d[0]) * r[1];
    EXPECT_NEAR(views.solid_angle[i], 2 * portable::atan2(across, along), 3e-15) << i;
  }
}

TEST(NewtonPotential, EqualsItsEdgeIntegrals) {
  const Panel p = skewPanel();
  for (const Vector3d& x : viewPoints(p)) {
    const double reference = reference::newtonPotential(p.corner, x);
    EXPECT_NEAR(computeNewtonPotential(p, x) / reference, 1, 1e-11) << x.transpose();
  }
}

TEST(NewtonPotential, IsFiniteAndContinuousOnThePanelItsEdgesAndCorners) {
  const Panel p = skewPanel();
  for (const Vector3d& x : {p.centroid, Vector3d(p.corner[0] + 0.3 * p.edge[0]), p.corner[2]}) {
    const double on = computeNewtonPotential(p, x);
    EXPECT_NEAR(computeNewtonPotential(p, x + 1e-9 * p.normal) / on, 1, 1e-7);
    EXPECT_NEAR(computeNewtonPotential(p, x - 1e-9 * p.normal) / on, 1, 1e-7);
    EXPECT_NEAR(on / reference::newtonPotential(p.corner, x), 1, 1e-9);
  }
}

TEST(DoubleLayer, EqualsTheIntegralOverTheSurface) {
  const Panel p = skewPanel();
  for (const Vector3d& x : {Vector3d(p.centroid + 0.5 * p.normal), Vector3d(3, -2, 1),
                            Vector3d(p.corner[1] - 0.4 * p.normal + 0.2 * p.edge[1])}) {
    const Vector3d weights = computeDoubleLayer(p, x);
    for (int a = 0; a < 3; ++a) {
      const double reference = reference::integrateOverTriangle(
          p.corner,
          [&](const Vector3d& y) {
            const double hat = 1 + p.hatGradient(a).dot(y - p.corner[a]);
            return hat * p.normal.dot(x - y) / std::pow((x - y).norm(), 3);
          },
          kFineStep);
      EXPECT_NEAR(weights[a], reference, 1e-11) << a;
    }
  }
}

TEST(DoubleLayer, SumsToTheSolidAngleOfAnOctant) {
  // Face of an octahedron, an eighth of the sphere seen from the origin.
  const Panel p = makePanel({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(computeDoubleLayer(p, Vector3d::Zero()).sum(), -4 * kPi / 8, 1e-14);
  EXPECT_NEAR(computeDoubleLayer(p, Vector3d::Ones() * 2 / 3).sum(), 4 * kPi / 8, 1e-14);
}

TEST(DoubleLayer, JumpsBy4PiAcrossThePanelAndVanishesBesideIt) {
  const Panel p = skewPanel();
  const double above = computeDoubleLayer(p, p.centroid + 1e-9 * p.normal).sum();
  const double below = computeDoubleLayer(p, p.centroid - 1e-9 * p.normal).sum();
  EXPECT_NEAR(above - below, 4 * kPi, 1e-6);
  EXPECT_NEAR(computeDoubleLayer(p, p.centroid + 3 * p.edge[0]).norm(), 0, 1e-14);
}

// Meshes as sheets: pair integrals do not need a closed surface.
PanelSurface surfaceOf(const std::vector<Vector3d>& vertices,
                       const std::vector<Eigen::Vector3i>& triangles) {
  return makePanelSurface(meshOf(vertices, triangles), true);
}

double referenceOf(const PanelSurface& surface, int t, int s, double step = 0.15) {
  return reference::pairIntegral(surface.panels[t].corner, surface.panels[s].corner, step);
}

double relativeError(const PanelSurface& surface, int t, int s, double reference) {
  return computePairIntegral(surface, t, s) / reference - 1;
}

TEST(PairIntegral, OfATriangleWithItselfIsExact) {
  const PanelSurface surface =
      surfaceOf({{0, 0, 0}, {1.3, 0.1, 0.2}, {0.4, 0.8, -0.5}}, {{0, 1, 2}});
  ASSERT_EQ(classifyPair(surface, 0, 0), PairKind::Same);
  // Accuracy here: 1e-9 of the reference, rounding of the closed form.
  EXPECT_NEAR(relativeError(surface, 0, 0, referenceOf(surface, 0, 0)), 0, 1e-8);
}

TEST(PairIntegral, OfASharedVertexIsExactAtEveryAngle) {
  for (double lift : {-1.2, -0.3, 0.0, 0.6}) {
    const PanelSurface surface =
        surfaceOf({{0, 0, 0}, {1, -0.2, 0}, {0.9, 0.5, 0.1}, {-0.8, 0.4, lift}, {-0.9, -0.5, lift}},
                  {{0, 1, 2}, {0, 3, 4}});
    ASSERT_EQ(classifyPair(surface, 0, 1), PairKind::SharedVertex);
    // 6 Gauss points on smooth functions; measured at most 1e-10.
    EXPECT_NEAR(relativeError(surface, 0, 1, referenceOf(surface, 0, 1)), 0, 1e-9) << lift;
  }
}

TEST(PairIntegral, OfASharedEdgeIsAccurateAtEveryAngle) {
  for (double lift : {-2.0, -0.3, 0.0, 0.6, 1.5}) {
    const PanelSurface surface = surfaceOf(
        {{0, 0, 0}, {1, 0.1, 0}, {0.4, 0.9, 0}, {0.6, -0.7, lift}}, {{0, 1, 2}, {0, 3, 1}});
    ASSERT_EQ(classifyPair(surface, 0, 1), PairKind::SharedEdge);
    // 6 Gauss points on t^2 ln t; measured at most 3.3e-6, at the steepest fold.
    EXPECT_NEAR(relativeError(surface, 0, 1, referenceOf(surface, 0, 1)), 0, 5e-6) << lift;
  }
}

TEST(PairIntegral, OfThinTrianglesThatTouchStaysAccurate) {
  // Strips of aspect 10, typical of a graded edge, folded by a right angle; measured 4.8e-5 at
  // most.
  const PanelSurface surface =
      surfaceOf({{0, 0, 0}, {1, 0, 0}, {1, 0.1, 0}, {0, 0.1, 0}, {0, 0, -0.1}, {1, 0, -0.1}},
                {{0, 1, 2}, {0, 2, 3}, {0, 4, 1}, {1, 4, 5}});
  for (int t = 0; t < 4; ++t)
    for (int s = t + 1; s < 4; ++s)
      EXPECT_NEAR(relativeError(surface, t, s, referenceOf(surface, t, s, 0.1)), 0, 1e-4)
          << t << ' ' << s;
}

struct Apart {
  PairKind kind;
  double distance;  ///< unit: radius of an equilateral triangle
  double tolerance;
};

TEST(PairIntegral, OfPairsApartIsAccurateInEveryClass) {
  // Smallest distance of each class; measured 3.3e-6, 1.1e-5, 1.4e-6 and 6.8e-6.
  const std::vector<Apart> cases = {{PairKind::Near, 1.1, 5e-6},
                                    {PairKind::Close, 2.4, 1.5e-5},
                                    {PairKind::Middle, 3.6, 2e-6},
                                    {PairKind::Far, 7.2, 1e-5}};
  for (const Apart& apart : cases) {
    const Vector3d d = apart.distance * Vector3d(0.6, 0.48, 0.64);
    const double h = std::sqrt(0.75);
    const PanelSurface surface = surfaceOf({{1, 0, 0},
                                            {-0.5, h, 0},
                                            {-0.5, -h, 0},
                                            Vector3d(Vector3d(0, 1, 0) + d),
                                            Vector3d(Vector3d(h, -0.5, 0) + d),
                                            Vector3d(Vector3d(-h, -0.5, 0) + d)},
                                           {{0, 1, 2}, {3, 4, 5}});
    ASSERT_EQ(classifyPair(surface, 0, 1), apart.kind);
    EXPECT_NEAR(relativeError(surface, 0, 1, referenceOf(surface, 0, 1, 0.2)), 0, apart.tolerance)
        << apart.distance;
  }
}

TEST(PairIntegral, OfPanelsFaceToFaceIsAccurate) {
  // Two sides of a thin body, 0.02 apart and shifted.
  const PanelSurface surface = surfaceOf(
      {{0, 0, 0}, {1, 0, 0}, {0.4, 0.9, 0}, {0.3, 0.1, 0.02}, {1.3, 0.2, 0.02}, {0.7, 1.0, 0.02}},
      {{0, 1, 2}, {3, 5, 4}});
  ASSERT_EQ(classifyPair(surface, 0, 1), PairKind::Near);
  // 16 points on a potential with kinks; measured 8e-4.
  EXPECT_NEAR(relativeError(surface, 0, 1, referenceOf(surface, 0, 1, 0.1)), 0, 1.5e-3);
}

TEST(PairIntegral, OfAFaceNextToMuchSmallerOnesDoesNotDependOnTheOrder) {
  // Points must lie on the smaller triangle in either order.
  const PanelSurface surface = surfaceOf(
      {{0, 0, 0}, {1, 0, 0}, {0.4, 0.9, 0}, {0.4, 0.3, 0.1}, {0.5, 0.3, 0.1}, {0.4, 0.4, 0.15}},
      {{0, 1, 2}, {3, 4, 5}});
  const double reference = referenceOf(surface, 1, 0, 0.1);
  EXPECT_NEAR(relativeError(surface, 0, 1, reference), 0, 1e-7);
  EXPECT_EQ(computePairIntegral(surface, 0, 1), computePairIntegral(surface, 1, 0));
}

}  // namespace
}  // namespace ambient
