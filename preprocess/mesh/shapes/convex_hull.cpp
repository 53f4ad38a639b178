#include "preprocess/mesh/shapes/convex_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {
namespace {

using Eigen::Index;
__extension__ using Wide = __int128;  // of 93 bits, the product of three differences of points
using Lattice = std::array<std::int64_t, 3>;

Lattice minus(const Lattice& a, const Lattice& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

std::array<Wide, 3> crossOf(const Lattice& a, const Lattice& b) {
  const auto product = [](std::int64_t x, std::int64_t y) { return static_cast<Wide>(x) * y; };
  return {product(a[1], b[2]) - product(a[2], b[1]), product(a[2], b[0]) - product(a[0], b[2]),
          product(a[0], b[1]) - product(a[1], b[0])};
}

struct Facet {
  std::array<int, 3> corners{};
  std::array<int, 3> across{};  ///< the facet beyond the side from corner k to k + 1
  std::vector<int> outside;     ///< points before its plane
  bool is_removed = false;
};

/// A side of the facets that a point sees, and the facet beyond it that it does not.
struct HorizonEdge {
  int from = 0, to = 0, beyond = 0;
};

class HullBuilder {
 public:
  explicit HullBuilder(std::vector<Lattice> points) : points_(std::move(points)) {}

  /// Corners of the triangles; none if the points do not span a volume.
  std::vector<Eigen::Vector3i> build() {
    if (!startWithTetrahedron()) return {};
    while (!waiting_.empty()) {
      const int facet = waiting_.back();
      waiting_.pop_back();
      if (!at(facet).is_removed && !at(facet).outside.empty()) addPoint(farthestFrom(facet), facet);
    }
    std::vector<Eigen::Vector3i> triangles;
    for (const Facet& facet : facets_)
      if (!facet.is_removed)
        triangles.emplace_back(facet.corners[0], facet.corners[1], facet.corners[2]);
    return triangles;
  }

 private:
  Facet& at(int facet) { return facets_[static_cast<std::size_t>(facet)]; }
  const Lattice& point(int p) const { return points_[static_cast<std::size_t>(p)]; }

  /// Sixfold volume of a tetrahedron: positive if d lies where the normal of a, b, c points to.
  Wide volume(int a, int b, int c, int d) const {
    const auto normal = crossOf(minus(point(b), point(a)), minus(point(c), point(a)));
    const Lattice to_d = minus(point(d), point(a));
    return normal[0] * to_d[0] + normal[1] * to_d[1] + normal[2] * to_d[2];
  }
  Wide height(int facet, int p) {
    const auto& corners = at(facet).corners;
    return volume(corners[0], corners[1], corners[2], p);
  }

  /// The point for which `measure` is largest, and at least 1; -1: there is none.
  template <class Measure>
  int best(const Measure& measure) const {
    int found = -1;
    double most = 0;
    for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
      const double value = measure(p);
      if (value <= most) continue;
      most = value;
      found = p;
    }
    return found;
  }

  bool startWithTetrahedron() {
    const auto squared = [](const auto& v) {
      double sum = 0;
      for (const auto x : v) sum += static_cast<double>(x) * static_cast<double>(x);
      return sum;
    };
    const int a = 0;
    const int b = best([&](int p) { return squared(minus(point(p), point(a))); });
    if (b < 0) return false;
    const Lattice ab = minus(point(b), point(a));
    const int c = best([&](int p) { return squared(crossOf(ab, minus(point(p), point(a)))); });
    if (c < 0) return false;
    const int d = best([&](int p) { return std::abs(static_cast<double>(volume(a, b, c, p))); });
    if (d < 0) return false;
    const bool is_behind = volume(a, b, c, d) < 0;
    const std::array<int, 4> v =
        is_behind ? std::array<int, 4>{a, b, c, d} : std::array<int, 4>{a, c, b, d};
    facets_ = {{{v[0], v[1], v[2]}, {1, 2, 3}, {}, false},
               {{v[1], v[0], v[3]}, {0, 3, 2}, {}, false},
               {{v[2], v[1], v[3]}, {0, 1, 3}, {}, false},
               {{v[0], v[2], v[3]}, {0, 2, 1}, {}, false}};
    std::vector<int> all;
    for (int p = 0; p < static_cast<int>(points_.size()); ++p) all.push_back(p);
    waiting_ = {0, 1, 2, 3};
    distribute(all, waiting_);
    return true;
  }

  /// Gives each point to a facet that it lies before; those before none are inside.
  void distribute(const std::vector<int>& points, const std::vector<int>& facets) {
    for (const int p : points) {
      for (const int facet : facets) {
        if (height(facet, p) <= 0) continue;
        at(facet).outside.push_back(p);
        break;
      }
    }
  }

  int farthestFrom(int facet) {
    const std::vector<int>& outside = at(facet).outside;
    return *std::max_element(outside.begin(), outside.end(),
                             [&](int p, int q) { return height(facet, p) < height(facet, q); });
  }

  /// Replaces the facets that a point sees, those in its plane included, by a fan around it. No
  /// triangle of the fan is flat: the facet beyond a side in line with the point is in its plane.
  void addPoint(int p, int seen) {
    std::vector<int> orphans;
    const std::vector<HorizonEdge> horizon = removeSeen(p, seen, orphans);
    std::map<int, int> facet_from, facet_to;  // by the corner of its edge
    std::vector<int> fan;
    for (const HorizonEdge& edge : horizon) {
      const int number = static_cast<int>(facets_.size());
      facets_.push_back({{edge.from, edge.to, p}, {edge.beyond, -1, -1}, {}, false});
      Facet& beyond = at(edge.beyond);
      for (std::size_t k = 0; k < 3; ++k)
        if (beyond.corners[k] == edge.to && beyond.corners[(k + 1) % 3] == edge.from)
          beyond.across[k] = number;
      facet_from[edge.from] = facet_to[edge.to] = number;
      fan.push_back(number);
    }
    for (const int number : fan) {
      Facet& facet = at(number);
      facet.across[1] = facet_from.at(facet.corners[1]);
      facet.across[2] = facet_to.at(facet.corners[0]);
    }
    distribute(orphans, fan);
    waiting_.insert(waiting_.end(), fan.begin(), fan.end());
  }

  std::vector<HorizonEdge> removeSeen(int p, int seen, std::vector<int>& orphans) {
    std::vector<HorizonEdge> horizon;
    std::vector<int> open{seen};
    at(seen).is_removed = true;
    while (!open.empty()) {
      const Facet facet = at(open.back());
      open.pop_back();
      for (const int q : facet.outside)
        if (q != p) orphans.push_back(q);
      for (std::size_t k = 0; k < 3; ++k) {
        Facet& other = at(facet.across[k]);
        if (other.is_removed) continue;
        if (height(facet.across[k], p) >= 0) {
          other.is_removed = true;
          open.push_back(facet.across[k]);
        } else {
          horizon.push_back({facet.corners[k], facet.corners[(k + 1) % 3], facet.across[k]});
        }
      }
    }
    return horizon;
  }

  std::vector<Lattice> points_;
  std::vector<Facet> facets_;
  std::vector<int> waiting_;  // facets that may have points before them
};

/// Points as multiples of 2^-bits of the extent along each axis.
std::vector<Lattice> onLattice(const Eigen::Matrix3Xd& points, int bits) {
  const Eigen::Vector3d low = points.rowwise().minCoeff();
  const Eigen::Vector3d extents = points.rowwise().maxCoeff() - low;
  std::vector<Lattice> lattice;
  for (Index i = 0; i < points.cols(); ++i) {
    Lattice point{};
    for (Index k = 0; k < 3; ++k) {
      const double scale = extents[k] > 0 ? std::ldexp(1.0, bits) / extents[k] : 0;
      point[static_cast<std::size_t>(k)] = std::llround((points(k, i) - low[k]) * scale);
    }
    lattice.push_back(point);
  }
  return lattice;
}

/// Whether a closed mesh encloses more than rounding, a millionth of its size times its area.
bool hasVolume(const TriangleMesh& mesh) {
  constexpr double kLeastThickness = 1e-6;
  return tetrahedraVolume(mesh, mesh.vertices.col(0)) >
         kLeastThickness * mesh.extents().maxCoeff() * areaOf(mesh);
}

}  // namespace

TriangleMesh makeConvexHull(const Eigen::Matrix3Xd& points, const std::string& name, int bits) {
  constexpr Index kLeastPoints = 4;
  if (points.cols() < kLeastPoints)
    raiseInputError(name, "a convex hull of ", points.cols(), " points needs at least ",
                    kLeastPoints);
  if (!points.allFinite()) raiseInputError(name, "a point of the hull is not finite");
  const std::vector<Eigen::Vector3i> triangles = HullBuilder(onLattice(points, bits)).build();
  const TriangleMesh mesh = withUsedVertices(points, triangles);
  if (triangles.empty() || !hasVolume(mesh))
    raiseInputError(name, "the points of the hull lie in a plane");
  return mesh;
}

}  // namespace ambient
