#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

namespace ambient {

/// Node of a rule on [0, 1]: mean of f = sum weight f(position).
struct SegmentNode {
  double position, weight;
};

/// Node of a rule on a triangle, in barycentric coordinates: mean of f = sum weight f(point).
struct TriangleNode {
  std::array<double, 3> barycentric;
  double weight;
};

/// Gauss-Legendre, 6 points, exact to degree 11.
inline constexpr std::array<SegmentNode, 6> kSegmentRule = {{
    {0.033765242898423975, 0.085662246189584873},
    {0.16939530676686776, 0.18038078652406947},
    {0.38069040695840151, 0.23395696728634569},
    {0.61930959304159849, 0.23395696728634569},
    {0.83060469323313224, 0.18038078652406947},
    {0.96623475710157603, 0.085662246189584873},
}};

namespace quadrature_detail {

/// The nodes of one orbit of the triangle's symmetries, written to `rule` from `first` on.
template <std::size_t N>
constexpr void addOrbit3(std::array<TriangleNode, N>& rule, std::size_t first, double b, double w) {
  const double a = 1 - 2 * b;
  rule[first] = {{a, b, b}, w};
  rule[first + 1] = {{b, a, b}, w};
  rule[first + 2] = {{b, b, a}, w};
}

constexpr std::array<TriangleNode, 6> makeRule6() {
  std::array<TriangleNode, 6> rule{};
  addOrbit3(rule, 0, 0.44594849091596488632, 0.2233815896780114657);
  addOrbit3(rule, 3, 0.09157621350977074346, 0.10995174365532186764);
  return rule;
}

constexpr std::array<TriangleNode, 16> makeRule16() {
  std::array<TriangleNode, 16> rule{};
  constexpr double third = 1.0 / 3.0;
  rule[0] = {{third, third, third}, 0.14431560767778716825};
  addOrbit3(rule, 1, 0.45929258829272315603, 0.095091634267284624794);
  addOrbit3(rule, 4, 0.17056930775176020662, 0.10321737053471825028);
  addOrbit3(rule, 7, 0.050547228317030975458, 0.032458497623198080311);
  constexpr double a = 0.0083947774099576053372, b = 0.26311282963463811342, c = 1 - a - b;
  constexpr double w = 0.027230314174434994265;
  rule[10] = {{a, b, c}, w};
  rule[11] = {{b, c, a}, w};
  rule[12] = {{c, a, b}, w};
  rule[13] = {{a, c, b}, w};
  rule[14] = {{c, b, a}, w};
  rule[15] = {{b, a, c}, w};
  return rule;
}

}  // namespace quadrature_detail

/// Symmetric Gauss rules on a triangle, exact to degree 4 and 8 (Dunavant 1985).
inline constexpr std::array<TriangleNode, 6> kTriangleRule6 = quadrature_detail::makeRule6();
inline constexpr std::array<TriangleNode, 16> kTriangleRule16 = quadrature_detail::makeRule16();

/// A flat triangle of the surface with what the integrals over it need. Counter-clockwise seen from
/// the side the normal points to. Unit of length: any.
struct Panel {
  std::array<Eigen::Vector3d, 3> corner;
  std::array<Eigen::Vector3d, 3> edge;         ///< corner k+1 - corner k
  std::array<Eigen::Vector3d, 3> edge_normal;  ///< unit, in the plane, pointing outward, of edge k
  std::array<double, 3> edge_length;
  Eigen::Vector3d normal;    ///< unit
  Eigen::Vector3d centroid;  ///< barycentre
  double area = 0;
  double radius = 0;  ///< largest distance of a corner from the centroid

  /// Surface gradient of the hat function of corner a (1 there, 0 at the other two) [1/length].
  Eigen::Vector3d hatGradient(int a) const {
    const int opposite = (a + 1) % 3;
    return edge_normal[opposite] * (-edge_length[opposite] / (2 * area));
  }
  /// n x hatGradient(a), the surface curl of the hat function up to its sign; docs/theory.md eq.
  /// (9).
  Eigen::Vector3d hatCurl(int a) const { return edge[(a + 1) % 3] / (2 * area); }
  /// Point with barycentric coordinates b.
  Eigen::Vector3d at(const std::array<double, 3>& b) const {
    return b[0] * corner[0] + b[1] * corner[1] + b[2] * corner[2];
  }
};

/// Makes a panel from its corners. If they span no area, its normal is not finite;
/// makePanelSurface() refuses such panels.
Panel makePanel(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

struct PanelNodes;
struct PanelNumbers;
struct PanelViews;

/// Returns the panel in plain numbers, for the kernels of panel_views.h.
PanelNumbers numbersOf(const Panel& panel);
/// Returns the points of kTriangleRule6 on a panel.
PanelNodes nodesOf(const Panel& panel);

/// Computes the views of a panel from up to 16 points, see panel_views.h.
PanelViews viewPanel(const Panel& panel, const Eigen::Vector3d* points, std::size_t count);

/// int_S 1/|x - y| dy [length] at up to 16 points x, exact for every x, on the panel too (Wilton et
/// al. 1984).
void computeNewtonPotentials(const Panel& panel, const Eigen::Vector3d* points, std::size_t count,
                             double* potentials);

}  // namespace ambient
