#include "preprocess/potential_flow/surface/panel_pair.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "preprocess/potential_flow/surface/panel.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// Limits of q. Regular meshes have rational squares of q; these have not, so that rounding never
// moves a pair to another class. Near reaches far enough to hold all panels that lie face to face
// on a thin body, whose potentials have kinks.
constexpr double kNearLimit = 1.1816;   // 2/3 sqrt(pi)
constexpr double kCloseLimit = 1.7725;  // sqrt(pi)

/// Corner numbers of the vertices that two triangles share.
struct SharedCorners {
  int count = 0;
  std::array<int, 3> of_t{}, of_s{};
};

SharedCorners findSharedCorners(const PanelSurface& surface, Index t, Index s) {
  SharedCorners shared;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (surface.triangles(a, t) == surface.triangles(b, s)) {
        shared.of_t[shared.count] = a;
        shared.of_s[shared.count++] = b;
      }
  return shared;
}

/// Self integral of a triangle, closed form.
double selfIntegral(const Panel& p) {
  const double perimeter = p.edge_length[0] + p.edge_length[1] + p.edge_length[2];
  double sum = 0;
  for (double l : p.edge_length) sum += 2 * portable::atanh(l / (perimeter - l)) / l;
  return 4.0 / 3.0 * p.area * p.area * sum;
}

/// Mean of the potential of `source` over points with weights.
template <std::size_t N>
double meanAt(const std::array<Vector3d, N>& points, const std::array<double, N>& weights,
              const Panel& source) {
  std::array<double, N> potentials;
  computeNewtonPotentials(source, points.data(), N, potentials.data());
  double mean = 0;
  for (std::size_t i = 0; i < N; ++i) mean += weights[i] * potentials[i];
  return mean;
}

/// Mean of the potential of `source` over the segment from a to b. Where a is a corner of the
/// source, the substitution u = t^2 removes the logarithm there.
double meanAlong(const Panel& source, const Vector3d& a, const Vector3d& b, bool from_corner) {
  std::array<Vector3d, kSegmentRule.size()> points;
  std::array<double, kSegmentRule.size()> weights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [t, weight] = kSegmentRule[i];
    points[i] = a + (from_corner ? t * t : t) * (b - a);
    weights[i] = from_corner ? weight * 2 * t : weight;
  }
  return meanAt(points, weights, source);
}

/// 1/r is homogeneous about the shared vertex, which leaves the two opposite edges.
double sharedVertexIntegral(const Panel& t, int corner_t, const Panel& s, int corner_s) {
  const double over_t =
      meanAlong(s, t.corner[(corner_t + 1) % 3], t.corner[(corner_t + 2) % 3], false);
  const double over_s =
      meanAlong(t, s.corner[(corner_s + 1) % 3], s.corner[(corner_s + 2) % 3], false);
  return 2.0 / 3.0 * (t.area * over_t + s.area * over_s);
}

/// Each end of the shared edge serves as a shared vertex; the average keeps both ends alike.
double sharedEdgeIntegral(const Panel& t, const Panel& s, const SharedCorners& shared) {
  const Vector3d& apex_t = t.corner[3 - shared.of_t[0] - shared.of_t[1]];
  const Vector3d& apex_s = s.corner[3 - shared.of_s[0] - shared.of_s[1]];
  double sum = 0;
  for (int end = 0; end < 2; ++end) {
    const Vector3d& p = t.corner[shared.of_t[end]];
    sum += t.area * meanAlong(s, p, apex_t, true) + s.area * meanAlong(t, p, apex_s, true);
  }
  return sum / 3;
}

/// Closed form on one panel times points on the other, the smaller one if they differ clearly: the
/// potential varies less there.
template <std::size_t N>
double analyticByPoints(const Panel& t, const Panel& s, const std::array<TriangleNode, N>& rule) {
  constexpr double kClearlySmaller = 0.7937;
  const bool on_s = s.radius < kClearlySmaller * t.radius;
  const Panel& outer = on_s ? s : t;
  const Panel& inner = on_s ? t : s;
  std::array<Vector3d, N> points;
  std::array<double, N> weights;
  for (std::size_t i = 0; i < N; ++i) {
    points[i] = outer.at(rule[i].barycentric);
    weights[i] = rule[i].weight;
  }
  return outer.area * meanAt(points, weights, inner);
}

double pointsByPoints(const PanelSurface& surface, Index t, Index s) {
  static const auto mean = kMeanInverseDistance.fastest();
  return surface.panels[t].area * surface.panels[s].area * mean(surface.nodes[t], surface.nodes[s]);
}

}  // namespace

PairKind classifyPair(const PanelSurface& surface, Index t, Index s) {
  const Panel& a = surface.panels[t];
  const Panel& b = surface.panels[s];
  const double radii = a.radius + b.radius;
  const double square = (a.centroid - b.centroid).squaredNorm();
  if (square > kFarLimit * kFarLimit * radii * radii) return PairKind::Far;
  switch (findSharedCorners(surface, t, s).count) {
    case 0:
      break;
    case 1:
      return PairKind::SharedVertex;
    case 2:
      return PairKind::SharedEdge;
    default:
      return PairKind::Same;
  }
  const double q = std::sqrt(square) / radii;
  return q < kNearLimit ? PairKind::Near : q < kCloseLimit ? PairKind::Close : PairKind::Middle;
}

double computePairIntegral(const PanelSurface& surface, Index t, Index s) {
  return computePairIntegral(surface, t, s, classifyPair(surface, t, s));
}

double computePairIntegral(const PanelSurface& surface, Index t, Index s, PairKind kind) {
  const Panel& a = surface.panels[t];
  const Panel& b = surface.panels[s];
  switch (kind) {
    case PairKind::Same:
      return selfIntegral(a);
    case PairKind::SharedEdge:
      return sharedEdgeIntegral(a, b, findSharedCorners(surface, t, s));
    case PairKind::SharedVertex: {
      const SharedCorners shared = findSharedCorners(surface, t, s);
      return sharedVertexIntegral(a, shared.of_t[0], b, shared.of_s[0]);
    }
    case PairKind::Near:
      return analyticByPoints(a, b, kTriangleRule16);
    case PairKind::Close:
      return analyticByPoints(a, b, kTriangleRule6);
    case PairKind::Middle:
      return pointsByPoints(surface, t, s);
    case PairKind::Far:
      break;
  }
  Eigen::ArrayXd integral(1);
  computeFarPairIntegrals(surface.arrays, t, s, integral);
  return integral[0];
}

void computeFarPairIntegrals(const PanelArrays& a, Index t, Index from, Eigen::ArrayXd& row) {
  constexpr Index kBlock = 256;  // small enough for the first cache
  using FarArray = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kBlock, 1>;
  for (Index first = 0; first < row.size(); first += kBlock) {
    const Index count = std::min(kBlock, row.size() - first);
    const auto part = [&](const Eigen::ArrayXd& array) {
      return array.segment(from + first, count);
    };
    const FarArray x = a.x[t] - part(a.x), y = a.y[t] - part(a.y), z = a.z[t] - part(a.z);
    const FarArray xx = a.xx[t] + part(a.xx), yy = a.yy[t] + part(a.yy), zz = a.zz[t] + part(a.zz);
    const FarArray inverse_square = 1 / (x * x + y * y + z * z);
    const FarArray along =
        x * (x * xx + 2 * (y * (a.xy[t] + part(a.xy)) + z * (a.xz[t] + part(a.xz)))) +
        y * (y * yy + 2 * z * (a.yz[t] + part(a.yz))) + z * z * zz;
    row.segment(first, count) =
        a.area[t] * part(a.area) * inverse_square.sqrt() *
        (1 + (1.5 * along * inverse_square - 0.5 * (xx + yy + zz)) * inverse_square);
  }
}

}  // namespace ambient
