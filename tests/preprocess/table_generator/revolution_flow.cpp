#include "tests/preprocess/table_generator/revolution_flow.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/parallel_for.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/large_products.h"

namespace ambient {
namespace {

constexpr int kPoints = 12;  // Gauss points of a panel
// Size of the last panel of a piece over the shortest piece. Unresolved energy is quadratic in it
// at a blunt edge, linear at a knife edge.
constexpr double kLeastPanel = 1.0 / 512;
// Smallest part of a panel, halved near a singular kernel. Below it rounding of normal distances
// dominates.
constexpr double kLeastPart = 1e-6;

struct GaussRule {
  std::array<double, kPoints> at, weight;  // on [0, 1]
};

GaussRule makeGaussRule() {
  GaussRule rule;
  for (int i = 0; i < kPoints; ++i) {
    double x = portable::cos(kPi * (i + 0.75) / (kPoints + 0.5)), slope = 1;
    for (int step = 0; step < 100; ++step) {
      double previous = 1, value = x;
      for (int n = 2; n <= kPoints; ++n) {
        const double next = ((2 * n - 1) * x * value - (n - 1) * previous) / n;
        previous = value;
        value = next;
      }
      slope = kPoints * (x * value - previous) / (x * x - 1);
      const double change = value / slope;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    rule.at[i] = (1 - x) / 2;
    rule.weight[i] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

const GaussRule& gaussRule() {
  static const GaussRule rule = makeGaussRule();
  return rule;
}

/// Part of a piece with Gauss points.
struct Panel {
  const MeridianPiece* piece;
  double begin, end;  // fractions of the piece

  double fraction(double x) const { return begin + x * (end - begin); }
  MeridianPoint at(double x) const { return piece->at(fraction(x)); }
};

/// Gauss point of a panel, with the data of the equations.
struct Node {
  MeridianPoint point;
  Eigen::Vector2d normal;
  double weight;  // weight of an integral over the meridian [m]
};

std::vector<Panel> panelsOf(const Meridian& meridian) {
  double shortest = meridian.front().length();
  for (const MeridianPiece& piece : meridian) shortest = std::min(shortest, piece.length());
  std::vector<Panel> panels;
  for (const MeridianPiece& piece : meridian) {
    std::vector<double> ends = {0.5};
    while (ends.back() * piece.length() > kLeastPanel * shortest) ends.push_back(ends.back() / 2);
    panels.push_back({&piece, 0, ends.back()});
    for (std::size_t i = ends.size() - 1; i > 0; --i)
      panels.push_back({&piece, ends[i], ends[i - 1]});
    for (std::size_t i = 1; i < ends.size(); ++i)
      panels.push_back({&piece, 1 - ends[i - 1], 1 - ends[i]});
    panels.push_back({&piece, 1 - ends.back(), 1});
  }
  return panels;
}

Node nodeAt(const Panel& panel, double x, double weight) {
  const double length = panel.piece->length() * (panel.end - panel.begin);
  return {panel.at(x), panel.piece->normalAt(panel.fraction(x)), weight * length};
}

std::vector<Node> nodesOf(const std::vector<Panel>& panels) {
  const GaussRule& rule = gaussRule();
  std::vector<Node> nodes;
  for (const Panel& panel : panels)
    for (int i = 0; i < kPoints; ++i) nodes.push_back(nodeAt(panel, rule.at[i], rule.weight[i]));
  return nodes;
}

/// Values at x of the polynomials that are 1 at one Gauss point and 0 at the others.
std::array<double, kPoints> lagrange(double x) {
  const GaussRule& rule = gaussRule();
  std::array<double, kPoints> values;
  for (int i = 0; i < kPoints; ++i) {
    values[i] = 1;
    for (int j = 0; j < kPoints; ++j)
      if (j != i) values[i] *= (x - rule.at[j]) / (rule.at[i] - rule.at[j]);
  }
  return values;
}

/// Integrals over a panel of kernel times polynomials, for one target.
struct PanelRow {
  std::array<double, kPoints> source[2] = {}, dipole[2] = {};

  void add(const MeridianPoint& target, const Node& node, int i, double share) {
    const RingKernel kernel = ringKernel(target, node.point, node.normal);
    const double weight = share * node.weight * node.point.x();
    for (int m = 0; m < 2; ++m) {
      source[m][i] += weight * kernel.source[m];
      dipole[m][i] += weight * kernel.dipole[m];
    }
  }

  /// Adds the part [from, to] of the panel; halves it if the target is near.
  void addPart(const MeridianPoint& target, const Panel& panel, double from, double to) {
    const MeridianPoint a = panel.at(from), b = panel.at(to), c = panel.at((from + to) / 2);
    const double distance =
        std::min({(a - target).norm(), (b - target).norm(), (c - target).norm()});
    const double length = (c - a).norm() + (b - c).norm();
    if (distance < 1.2 * length && to - from > kLeastPart) {
      addPart(target, panel, from, (from + to) / 2);
      addPart(target, panel, (from + to) / 2, to);
      return;
    }
    const GaussRule& rule = gaussRule();
    for (int q = 0; q < kPoints; ++q) {
      const double x = from + rule.at[q] * (to - from);
      const Node node = nodeAt(panel, x, rule.weight[q] * (to - from));
      if ((node.point - target).squaredNorm() == 0) continue;
      const std::array<double, kPoints> shares = lagrange(x);
      for (int i = 0; i < kPoints; ++i) add(target, node, i, shares[i]);
    }
  }
};

/// Matrices of 1/2 phi - D phi = -S g at all nodes.
struct Equations {
  Eigen::MatrixXd source, dipole;
};

std::array<Equations, 2> makeEquations(const std::vector<Panel>& panels,
                                       const std::vector<Node>& nodes) {
  const auto size = static_cast<Eigen::Index>(nodes.size());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(size, size);
  std::array<Equations, 2> equations = {Equations{zero, zero}, Equations{zero, zero}};
  parallelFor(threadCount(0), size, [&](Eigen::Index row) {
    for (std::size_t p = 0; p < panels.size(); ++p) {
      PanelRow integrals;
      integrals.addPart(nodes[row].point, panels[p], 0, 1);
      for (int m = 0; m < 2; ++m) {
        for (int i = 0; i < kPoints; ++i) {
          const auto column = static_cast<Eigen::Index>(kPoints * p + i);
          equations[m].source(row, column) = integrals.source[m][i];
          equations[m].dipole(row, column) = integrals.dipole[m][i];
        }
      }
    }
  });
  return equations;
}

/// Potentials on the body from its normal velocities.
Eigen::MatrixXd potentialsOf(const Equations& equations, const Eigen::MatrixXd& velocities) {
  fixBlocksOfLargeProducts();
  const Eigen::Index size = velocities.rows();
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size) / 2 - equations.dipole;
  return matrix.partialPivLu().solve(-equations.source * velocities);
}

}  // namespace

RevolutionInertia solveRevolutionFlow(const Meridian& meridian) {
  const std::vector<Panel> panels = panelsOf(meridian);
  const std::vector<Node> nodes = nodesOf(panels);
  const std::array<Equations, 2> equations = makeEquations(panels, nodes);
  const auto size = static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd along(size, 1), across(size, 2);  // normal velocities: heave; sway, pitch
  Eigen::VectorXd rings(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Node& node = nodes[i];
    along(i, 0) = node.normal.y();
    across(i, 0) = node.normal.x();
    across(i, 1) = node.normal.x() * node.point.y() - node.normal.y() * node.point.x();
    rings[i] = kPi * node.weight * node.point.x();
  }
  const Eigen::MatrixXd heave = potentialsOf(equations[0], along);
  const Eigen::MatrixXd swing = potentialsOf(equations[1], across);
  const double K_along = -2 * heave.col(0).cwiseProduct(rings).dot(along.col(0));
  const Eigen::Matrix2d K = -swing.transpose() * rings.asDiagonal() * across;
  return {K_along, K(0, 0), K(1, 1), (K(0, 1) + K(1, 0)) / 2};
}

}  // namespace ambient
