#pragma once

#include <array>

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

}  // namespace ambient
