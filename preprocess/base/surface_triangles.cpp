#include "preprocess/base/surface_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

constexpr double kFlat = 1e-6;  // tolerance for unit vectors
constexpr double kSingle =
    5e-7;  // rounding of a vertex by single precision, of its largest coordinate

}  // namespace

SurfaceTriangles::SurfaceTriangles(const FluidBody& body) {
  const std::size_t count = body.surface.triangles.size() / 3;
  const std::size_t faces = body.faces.size();
  if (faces != count && faces != 2 * count)
    reject(body, "number of its faces", static_cast<double>(faces),
           "that of the triangles of its surface, or twice that of a sheet's, for the form law");
  is_sheet_ = count > 0 && faces == 2 * count;
  weld(body.surface);
  for (std::size_t t = 0; t < count; ++t) normals_.push_back(body.faces.normal(t));
}

SurfaceTriangles::SurfaceTriangles(const Surface& surface) {
  weld(surface);
  setTriangles(std::move(corners_));
}

void SurfaceTriangles::setTriangles(std::vector<std::array<int, 3>> corners) {
  corners_ = std::move(corners);
  normals_.clear();
  normals_.reserve(corners_.size());
  for (int t = 0; t < size(); ++t) {
    const auto corner = [&](int i) { return place(vertex(t, i)); };
    normals_.push_back((corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized());
  }
}

void SurfaceTriangles::weld(const Surface& surface) {
  AMBIENT_ASSERT(surface.triangles.size() % 3 == 0 && surface.vertices.size() % 3 == 0);
  constexpr int kUnknown = -1;
  const std::size_t count = surface.vertices.size() / 3;
  places_.reserve(count);
  sources_.reserve(count);
  const auto at = [&](std::size_t vertex) {
    const double* p = &surface.vertices[3 * vertex];
    return std::tie(p[0], p[1], p[2]);
  };
  std::vector<std::uint32_t> sorted(count), first(count);  // by place; the first one at each place
  std::iota(sorted.begin(), sorted.end(), 0U);
  std::sort(sorted.begin(), sorted.end(),
            [&](std::uint32_t a, std::uint32_t b) { return at(a) < at(b); });
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_new = i == 0 || at(sorted[i - 1]) < at(sorted[i]);
    first[sorted[i]] = is_new ? sorted[i] : first[sorted[i - 1]];
  }
  std::vector<int> numbers(count, kUnknown);
  const auto corner = [&](std::size_t i) {
    const std::int32_t vertex = surface.triangles[i];
    AMBIENT_ASSERT(vertex >= 0 && static_cast<std::size_t>(vertex) < count);
    int& number = numbers[first[static_cast<std::size_t>(vertex)]];
    if (number != kUnknown) return number;
    number = vertexCount();
    const auto [x, y, z] = at(static_cast<std::size_t>(vertex));
    places_.emplace_back(x, y, z);
    sources_.push_back(vertex);
    rounding_ = std::max(rounding_, kSingle * places_.back().cwiseAbs().maxCoeff());
    return number;
  };
  corners_.reserve(surface.triangles.size() / 3);
  for (std::size_t t = 0; t < surface.triangles.size() / 3; ++t)
    corners_.push_back({corner(3 * t), corner(3 * t + 1), corner(3 * t + 2)});
}

std::vector<Vector3> SurfaceTriangles::places(const std::vector<int>& vertices) const {
  std::vector<Vector3> result;
  for (const int vertex : vertices) result.push_back(place(vertex));
  return result;
}

double SurfaceTriangles::area(int triangle) const {
  const Vector3& first = place(vertex(triangle, 0));
  return (place(vertex(triangle, 1)) - first).cross(place(vertex(triangle, 2)) - first).norm() / 2;
}

double SurfaceTriangles::turnByRounding(int triangle) const {
  double longest = 0;
  for (int corner = 0; corner < 3; ++corner) {
    const int here = vertex(triangle, corner), next = vertex(triangle, (corner + 1) % 3);
    longest = std::max(longest, (place(next) - place(here)).norm());
  }
  return rounding_ * longest / (2 * area(triangle));
}

namespace {

using Edge = std::pair<int, int>;

class SideFinder {
 public:
  explicit SideFinder(const SurfaceTriangles& mesh)
      : mesh_(mesh), side_of_(static_cast<std::size_t>(mesh.size()), kNone) {
    first_.resize(static_cast<std::size_t>(mesh.vertexCount()) + 1);
    ends_.resize(3 * side_of_.size());
    for (int t = 0; t < mesh.size(); ++t)
      for (int corner = 0; corner < 3; ++corner) ++first_[at(mesh.vertex(t, corner))];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    for (int t = mesh.size() - 1; t >= 0; --t)
      for (int corner = 0; corner < 3; ++corner) {
        const auto [begin, end] = edge(t, corner);
        ends_[--first_[at(begin)]] = {end, t};
      }
  }

  std::vector<FlatSide> sides() {
    std::vector<FlatSide> found;
    for (int t = 0; t < mesh_.size(); ++t) {
      if (side_of_[at(t)] != kNone) continue;
      FlatSide side = planeFrom(t);
      const std::vector<int>& ring = outlineOf(side);
      side.corners = cornersOf(ring, side.normal);
      side.is_in_rows = isInRows(ring, side);
      side.has_sharp_rim = hasSharpRim(side);
      if (side.corners.size() >= 3) found.push_back(std::move(side));
    }
    return found;
  }

 private:
  static constexpr int kNone = -1;

  Edge edge(int t, int corner) const {
    return {mesh_.vertex(t, corner), mesh_.vertex(t, (corner + 1) % 3)};
  }

  /// Index of the triangle on the other side of an edge, of several the last one; -1: none.
  int beyond(const Edge& edge) const {
    int triangle = -1;
    for (std::size_t i = first_[at(edge.second)]; i < first_[at(edge.second) + 1]; ++i)
      if (ends_[i].vertex == edge.first) triangle = ends_[i].triangle;
    return triangle;
  }
  /// True if a triangle belongs to the same side as `t`.
  bool isBeside(int triangle, int t) const {
    return triangle >= 0 && side_of_[at(triangle)] == side_of_[at(t)];
  }

  /// All triangles that hang together with `first` on its plane. The plane is that of the first
  /// triangle whose normal rounding leaves as it is, else of the one that it turns least.
  FlatSide planeFrom(int first) {
    FlatSide side{{first}, {}, mesh_.normal(first)};
    double tolerance = std::max(kFlat, mesh_.turnByRounding(first));
    side_of_[at(first)] = first;
    for (std::size_t i = 0; i < side.triangles.size(); ++i)
      for (int corner = 0; corner < 3; ++corner) {
        const int next = beyond(edge(side.triangles[i], corner));
        if (next < 0 || side_of_[at(next)] != kNone) continue;
        const double turn = (mesh_.normal(next) - side.normal).cwiseAbs().maxCoeff();
        const double own =
            std::max(kFlat, turn > kFlat || tolerance > kFlat ? mesh_.turnByRounding(next) : 0);
        if (!(turn <= std::max(tolerance, own))) continue;
        side_of_[at(next)] = first;
        side.triangles.push_back(next);
        if (own >= tolerance) continue;
        tolerance = own;
        side.normal = mesh_.normal(next);
      }
    return side;
  }

  bool hasSharpRim(const FlatSide& side) const {
    for (const int t : side.triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const int next = beyond(edge(t, corner));
        if (next < 0 || isBeside(next, t)) continue;
        if (mesh_.normal(next).dot(side.normal) >= kEdgeCosine) return false;
      }
    return true;
  }

  /// Vertices around the side in order; empty if they do not form a single ring.
  const std::vector<int>& outlineOf(const FlatSide& side) {
    rim_.clear();
    ring_.clear();
    for (const int t : side.triangles)
      for (int corner = 0; corner < 3; ++corner)
        if (!isBeside(beyond(edge(t, corner)), t)) rim_.push_back(edge(t, corner));
    std::sort(rim_.begin(), rim_.end());
    for (auto next = rim_.begin(); next != rim_.end() && ring_.size() < rim_.size();) {
      ring_.push_back(next->first);
      if (next->second == ring_.front()) break;
      const int end = next->second;
      next = std::lower_bound(rim_.begin(), rim_.end(), Edge{end, 0});
      if (next != rim_.end() && next->first != end) next = rim_.end();
    }
    if (ring_.size() != rim_.size()) ring_.clear();
    return ring_;
  }

  /// True if no vertex lies inside an outline, and other sides continue this one smoothly at all
  /// that lie on it between corners.
  bool isInRows(const std::vector<int>& ring, const FlatSide& side) const {
    if (side.triangles.size() + 2 > ring.size() || side.corners.size() == ring.size()) return false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const int here = ring[i];
      if (std::find(side.corners.begin(), side.corners.end(), here) != side.corners.end()) continue;
      const int next = beyond({here, ring[(i + 1) % ring.size()]});
      if (next < 0 || mesh_.normal(next).dot(side.normal) < kEdgeCosine) return false;
    }
    return true;
  }

  /// Returns the corners of an outline; empty if it is not convex.
  std::vector<int> cornersOf(const std::vector<int>& ring, const Vector3& normal) const {
    std::vector<int> corners;
    corners.reserve(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector3& here = mesh_.place(ring[i]);
      const Vector3 in = here - mesh_.place(ring[(i + ring.size() - 1) % ring.size()]);
      const Vector3 out = mesh_.place(ring[(i + 1) % ring.size()]) - here;
      const double turn = normal.dot(in.cross(out));
      const double straight =
          std::max(kFlat * in.norm() * out.norm(), mesh_.rounding() * (in + out).norm());
      if (turn < -straight) return {};
      if (turn > straight) corners.push_back(ring[i]);
    }
    return corners;
  }

  /// End of an edge, and the triangle whose edge it is.
  struct End {
    int vertex, triangle;
  };
  static std::size_t at(int vertex) { return static_cast<std::size_t>(vertex); }

  const SurfaceTriangles& mesh_;
  std::vector<std::size_t> first_;  ///< place in ends_ of the first edge that begins at a vertex
  std::vector<End> ends_;           ///< of edges by their first vertex, then by triangle
  std::vector<int> side_of_;        ///< of each triangle: the first one of its side, or kNone
  std::vector<Edge> rim_;           ///< of the side whose outline is sought
  std::vector<int> ring_;           ///< its outline
};

}  // namespace

std::vector<FlatSide> findFlatSides(const SurfaceTriangles& mesh) {
  return SideFinder(mesh).sides();
}

WholeSides::WholeSides(const FluidBody& body) : mesh(body) {
  constexpr int kNone = -1;
  std::vector<std::array<int, 3>> corners;
  corners.reserve(static_cast<std::size_t>(mesh.size()));
  parts.assign(static_cast<std::size_t>(mesh.size()), kNone);
  std::vector<bool> is_replaced(parts.size());
  const auto add = [&](int a, int b, int c, int from, int of) {
    corners.push_back({a, b, c});
    face.push_back(from);
    side.push_back(of);
  };
  for (const FlatSide& flat : findFlatSides(mesh)) {
    if (flat.is_in_rows) continue;
    const std::vector<int>& c = flat.corners;
    const bool is_divided = c.size() < flat.triangles.size() + 2;
    for (const int t : flat.triangles) {
      parts[static_cast<std::size_t>(t)] = count;
      is_replaced[static_cast<std::size_t>(t)] = is_divided;
    }
    for (std::size_t i = 2; is_divided && i < c.size(); ++i)
      add(c[0], c[i - 1], c[i], kOfFan, count);
    ++count;
  }
  for (std::size_t t = 0; t < parts.size(); ++t) {
    if (parts[t] == kNone) parts[t] = count++;
    const auto i = static_cast<int>(t);
    if (!is_replaced[t]) add(mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2), i, parts[t]);
  }
  mesh.setTriangles(std::move(corners));
}

}  // namespace ambient
