#include "preprocess/base/surface_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

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
  for (int t = 0; t < size(); ++t) {
    const auto corner = [&](int i) { return place(vertex(t, i)); };
    normals_.push_back((corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized());
  }
}

void SurfaceTriangles::weld(const Surface& surface) {
  AMBIENT_ASSERT(surface.triangles.size() % 3 == 0 && surface.vertices.size() % 3 == 0);
  constexpr int kUnknown = -1;
  std::map<std::array<double, 3>, int> seen;
  std::vector<int> numbers(surface.vertices.size() / 3, kUnknown);
  const auto corner = [&](std::size_t i) {
    const auto vertex = static_cast<std::size_t>(surface.triangles[i]);
    AMBIENT_ASSERT(surface.triangles[i] >= 0 && vertex < numbers.size());
    if (numbers[vertex] != kUnknown) return numbers[vertex];
    const double* p = &surface.vertices[3 * vertex];
    const auto [entry, is_new] = seen.insert({{p[0], p[1], p[2]}, vertexCount()});
    if (is_new) places_.emplace_back(p[0], p[1], p[2]);
    if (is_new) sources_.push_back(surface.triangles[i]);
    return numbers[vertex] = entry->second;
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

namespace {

constexpr double kFlat = 1e-6;      // tolerance for unit vectors
constexpr double kRounding = 5e-7;  // of single precision, part of the distance from the origin

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
    double reach = 0;
    for (int v = 0; v < mesh.vertexCount(); ++v)
      reach = std::max(reach, mesh.place(v).cwiseAbs().maxCoeff());
    rounding_ = kRounding * reach;
  }

  std::vector<FlatSide> sides() {
    std::vector<FlatSide> found;
    for (int t = 0; t < mesh_.size(); ++t) {
      if (side_of_[at(t)] != kNone) continue;
      FlatSide side{planeFrom(t, static_cast<int>(found.size())), {}, {}, mesh_.normal(t)};
      setOutlines(side);
      side.has_sharp_rim = hasSharpRim(side);
      found.push_back(std::move(side));
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

  /// True if rounding may have turned the normal of a triangle away from `normal`.
  bool isOnPlane(int t, const Vector3& normal) const {
    const double turn = (mesh_.normal(t) - normal).cwiseAbs().maxCoeff();
    if (turn <= kFlat) return true;
    double longest = 0;
    for (int corner = 0; corner < 3; ++corner) {
      const auto [begin, end] = edge(t, corner);
      longest = std::max(longest, (mesh_.place(end) - mesh_.place(begin)).norm());
    }
    const Vector3& first = mesh_.place(mesh_.vertex(t, 0));
    const double twice_area = (mesh_.place(mesh_.vertex(t, 1)) - first)
                                  .cross(mesh_.place(mesh_.vertex(t, 2)) - first)
                                  .norm();
    return turn * twice_area <= rounding_ * longest;
  }

  /// All triangles that hang together with `first` on its plane, if no side has them.
  std::vector<int> planeFrom(int first, int side) {
    std::vector<int> triangles{first};
    side_of_[at(first)] = side;
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (int corner = 0; corner < 3; ++corner) {
        const int next = beyond(edge(triangles[i], corner));
        if (next < 0 || side_of_[at(next)] != kNone || !isOnPlane(next, mesh_.normal(first)))
          continue;
        side_of_[at(next)] = side;
        triangles.push_back(next);
      }
    return triangles;
  }

  /// Edges that a side does not have on both of their sides, by their first vertex.
  std::vector<Edge> rimOf(const FlatSide& side) const {
    std::vector<Edge> rim;
    for (const int t : side.triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const int next = beyond(edge(t, corner));
        if (next < 0 || side_of_[at(next)] != side_of_[at(t)]) rim.push_back(edge(t, corner));
      }
    std::sort(rim.begin(), rim.end());
    return rim;
  }

  bool hasSharpRim(const FlatSide& side) const {
    for (const int t : side.triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const int next = beyond(edge(t, corner));
        if (next < 0 || side_of_[at(next)] == side_of_[at(t)]) continue;
        if (mesh_.normal(next).dot(side.normal) >= kEdgeCosine) return false;
      }
    return true;
  }

  void setOutlines(FlatSide& side) const {
    const std::vector<Edge> rim = rimOf(side);
    std::vector<bool> is_used(rim.size());
    bool is_convex = true;
    for (std::size_t start = 0; start < rim.size(); ++start) {
      is_convex = is_convex && (start == 0 || rim[start].first != rim[start - 1].first);
      if (is_used[start]) continue;
      std::vector<int> ring;
      for (std::size_t i = start; i < rim.size() && !is_used[i];) {
        is_used[i] = true;
        ring.push_back(rim[i].first);
        i = nextOn(rim, is_used, rim[i].second);
      }
      is_convex = addOutline(ring, side) && is_convex;
    }
    if (!is_convex || side.outlines.size() != 1) return;
    for (const RimVertex& v : side.outlines.front())
      if (v.is_corner) side.corners.push_back(v.vertex);
    if (side.corners.size() < 3) side.corners.clear();
  }

  /// Index of an edge of a rim from `vertex` on that is not used; the size of the rim: none.
  static std::size_t nextOn(const std::vector<Edge>& rim, const std::vector<bool>& is_used,
                            int vertex) {
    auto i = static_cast<std::size_t>(std::lower_bound(rim.begin(), rim.end(), Edge{vertex, 0}) -
                                      rim.begin());
    while (i < rim.size() && rim[i].first == vertex && is_used[i]) ++i;
    return i < rim.size() && rim[i].first == vertex ? i : rim.size();
  }

  /// Adds a ring to the outlines of a side. Returns true if it is convex.
  bool addOutline(const std::vector<int>& ring, FlatSide& side) const {
    std::vector<RimVertex> outline;
    bool is_convex = true;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector3& here = mesh_.place(ring[i]);
      const Vector3 in = here - mesh_.place(ring[(i + ring.size() - 1) % ring.size()]);
      const Vector3 out = mesh_.place(ring[(i + 1) % ring.size()]) - here;
      const double turn = side.normal.dot(in.cross(out)), lengths = in.norm() * out.norm();
      const bool is_straight =
          std::abs(turn) <= std::max(kFlat * lengths, rounding_ * (in + out).norm());
      outline.push_back({ring[i], !is_straight});
      is_convex = is_convex && (is_straight || turn > 0);
    }
    side.outlines.push_back(std::move(outline));
    return is_convex;
  }

  /// End of an edge, and the triangle whose edge it is.
  struct End {
    int vertex, triangle;
  };
  static std::size_t at(int vertex) { return static_cast<std::size_t>(vertex); }

  const SurfaceTriangles& mesh_;
  std::vector<std::size_t> first_;  ///< place in ends_ of the first edge that begins at a vertex
  std::vector<End> ends_;           ///< of edges by their first vertex, then by triangle
  std::vector<int> side_of_;        ///< number of the side of each triangle, or kNone
  double rounding_;                 ///< of coordinates [m]
};

}  // namespace

std::vector<FlatSide> findFlatSides(const SurfaceTriangles& mesh) {
  return SideFinder(mesh).sides();
}

}  // namespace ambient
