#include "preprocess/base/surface_triangles.h"

#include <Eigen/Geometry>
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

constexpr double kFlat = 1e-6;  // tolerance for unit vectors: a mesh in single precision

using Edge = std::pair<int, int>;

class SideFinder {
 public:
  explicit SideFinder(const SurfaceTriangles& mesh)
      : mesh_(mesh), is_taken_(static_cast<std::size_t>(mesh.size())) {
    first_.resize(static_cast<std::size_t>(mesh.vertexCount()) + 1);
    ends_.resize(3 * is_taken_.size());
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
      if (isTaken(t)) continue;
      FlatSide side{planeFrom(t), {}, mesh_.normal(t)};
      side.corners = cornersOf(side);
      side.has_sharp_rim = hasSharpRim(side);
      if (side.corners.size() >= 3) found.push_back(std::move(side));
    }
    return found;
  }

 private:
  Edge edge(int t, int corner) const {
    return {mesh_.vertex(t, corner), mesh_.vertex(t, (corner + 1) % 3)};
  }
  std::vector<bool>::reference isTaken(int t) { return is_taken_[static_cast<std::size_t>(t)]; }

  /// Index of the triangle on the other side of an edge, of several the last one; -1: none.
  int beyond(const Edge& edge) const {
    int triangle = -1;
    for (std::size_t i = first_[at(edge.second)]; i < first_[at(edge.second) + 1]; ++i)
      if (ends_[i].vertex == edge.first) triangle = ends_[i].triangle;
    return triangle;
  }
  bool isOnPlaneOf(int t, const FlatSide& side) const {
    return t >= 0 && (mesh_.normal(t) - side.normal).cwiseAbs().maxCoeff() <= kFlat;
  }

  std::vector<int> planeFrom(int first) {  // all connected triangles with the normal of `first`
    const FlatSide plane{{}, {}, mesh_.normal(first)};
    std::vector<int> triangles{first};
    isTaken(first) = true;
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (int corner = 0; corner < 3; ++corner) {
        const int next = beyond(edge(triangles[i], corner));
        if (!isOnPlaneOf(next, plane) || isTaken(next)) continue;
        isTaken(next) = true;
        triangles.push_back(next);
      }
    return triangles;
  }

  bool hasSharpRim(const FlatSide& side) const {
    for (const int t : side.triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const int next = beyond(edge(t, corner));
        if (next < 0 || isOnPlaneOf(next, side)) continue;
        if (mesh_.normal(next).dot(side.normal) >= kEdgeCosine) return false;
      }
    return true;
  }

  /// Vertices around the side in order; empty if they do not form a single ring.
  std::vector<int> outlineOf(const FlatSide& side) const {
    std::map<int, int> next;
    std::size_t edges = 0;
    for (const int t : side.triangles)
      for (int corner = 0; corner < 3; ++corner) {
        const Edge e = edge(t, corner);
        if (isOnPlaneOf(beyond(e), side)) continue;
        next[e.first] = e.second;
        ++edges;
      }
    std::vector<int> ring;
    for (int at = next.begin()->first; ring.size() < edges;) {
      ring.push_back(at);
      const auto found = next.find(at);
      if (found == next.end()) return {};
      at = found->second;
      if (at == ring.front()) break;
    }
    return ring.size() == edges ? ring : std::vector<int>{};
  }

  /// Returns the corners of the outline; empty if the outline is not convex.
  std::vector<int> cornersOf(const FlatSide& side) const {
    const std::vector<int> ring = outlineOf(side);
    std::vector<int> corners;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector3& here = mesh_.place(ring[i]);
      const Vector3 in = here - mesh_.place(ring[(i + ring.size() - 1) % ring.size()]);
      const Vector3 out = mesh_.place(ring[(i + 1) % ring.size()]) - here;
      const double sine = side.normal.dot(in.normalized().cross(out.normalized()));
      if (sine < -kFlat) return {};
      if (sine > kFlat) corners.push_back(ring[i]);
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
  std::vector<bool> is_taken_;
};

}  // namespace

std::vector<FlatSide> findFlatSides(const SurfaceTriangles& mesh) {
  return SideFinder(mesh).sides();
}

}  // namespace ambient
