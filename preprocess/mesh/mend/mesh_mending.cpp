#include "preprocess/mesh/mend/mesh_mending.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

namespace {

using Eigen::Vector3d;
using Edge = std::pair<int, int>;

/// Directed edges that no triangle runs along the other way round, as often as one is missing; each
/// once, ascending.
std::vector<Edge> openEdges(const std::vector<Eigen::Vector3i>& triangles, std::size_t vertices) {
  // Where the edges of each vertex begin, and their other ends.
  std::vector<std::size_t> begin(vertices + 1, 0);
  for (const Eigen::Vector3i& t : triangles)
    for (const int v : t) ++begin[static_cast<std::size_t>(v) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> ends(3 * triangles.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (const Eigen::Vector3i& t : triangles)
    for (int k = 0; k < 3; ++k) ends[next[static_cast<std::size_t>(t[k])]++] = t[(k + 1) % 3];
  const auto endsAt = [&](std::size_t v) {
    const auto at = [&](std::size_t i) { return ends.begin() + static_cast<std::ptrdiff_t>(i); };
    return std::pair(at(begin[v]), at(begin[v + 1]));
  };
  std::vector<Edge> open;
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto [first, last] = endsAt(v);
    std::sort(first, last);
    for (auto end = first; end != last;) {
      const auto after = std::upper_bound(end, last, *end);
      const auto [from, to] = endsAt(static_cast<std::size_t>(*end));
      const int number = static_cast<int>(v);
      if (std::count(from, to, number) < after - end) open.emplace_back(number, *end);
      end = after;
    }
  }
  return open;
}

/// Places by their coordinates along each axis.
class SortedPlaces {
 public:
  void add(int vertex, const Vector3d& place) { axes_[0].push_back({place, vertex}); }

  void sort() {
    axes_[1] = axes_[2] = axes_[0];
    for (int axis = 0; axis < 3; ++axis)
      std::sort(axes_[axis].begin(), axes_[axis].end(),
                [=](const auto& v, const auto& w) { return v.place[axis] < w.place[axis]; });
  }

  /// Calls body(vertex, place) for those in a box, in any order.
  template <class Body>
  void forAllIn(const Eigen::AlignedBox3d& box, const Body& body) const {
    auto first = axes_[0].begin(), last = axes_[0].end();
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<Place>& along = axes_[axis];
      const auto from = std::partition_point(along.begin(), along.end(), [&](const Place& v) {
        return v.place[axis] < box.min()[axis];
      });
      const auto to = std::partition_point(
          from, along.end(), [&](const Place& v) { return v.place[axis] <= box.max()[axis]; });
      if (to - from < last - first) first = from, last = to;
    }
    for (; first != last; ++first)
      if (box.contains(first->place)) body(first->vertex, first->place);
  }

 private:
  struct Place {
    Vector3d place;
    int vertex;
  };
  std::array<std::vector<Place>, 3> axes_;
};

/// A side of a triangle: its first corner and the vertices on it, in order.
struct Side {
  int from = 0;
  std::vector<int> between;
};

class CrackMender {
 public:
  CrackMender(const TriangleMesh& mesh, double tolerance)
      : tolerance_(tolerance),
        points_(columnsOf(mesh.vertices)),
        triangles_(columnsOf(mesh.triangles)) {}

  /// False if there was nothing to divide.
  bool divideOnce() {
    const std::vector<Edge> open = openEdges(triangles_, points_.size());
    const SortedPlaces ends = endsOf(open);
    Insides inside;
    for (const Edge& edge : open) {
      std::vector<int> between = verticesOn(edge, ends);
      if (!between.empty()) inside.emplace_back(edge, std::move(between));
    }
    if (inside.empty()) return false;
    std::vector<Eigen::Vector3i> divided;
    for (const Eigen::Vector3i& triangle : triangles_) append(triangle, inside, divided);
    const bool is_divided = divided.size() > triangles_.size();
    triangles_ = std::move(divided);
    return is_divided;
  }

  TriangleMesh mesh() const { return makeTriangleMesh(points_, triangles_); }

 private:
  using Insides = std::vector<std::pair<Edge, std::vector<int>>>;  // ascending

  SortedPlaces endsOf(const std::vector<Edge>& edges) const {
    std::vector<bool> is_end(points_.size());
    for (const Edge& edge : edges) is_end[edge.first] = is_end[edge.second] = true;
    SortedPlaces ends;
    for (std::size_t v = 0; v < points_.size(); ++v)
      if (is_end[v]) ends.add(static_cast<int>(v), points_[v]);
    ends.sort();
    return ends;
  }

  // In order along the edge.
  std::vector<int> verticesOn(const Edge& edge, const SortedPlaces& candidates) const {
    const Vector3d a = points_[static_cast<std::size_t>(edge.first)];
    const Vector3d b = points_[static_cast<std::size_t>(edge.second)], along = b - a;
    const Vector3d room = Vector3d::Constant(2 * tolerance_);  // for rounding, too
    const double length = along.norm();
    std::vector<std::pair<double, int>> found;
    candidates.forAllIn({a.cwiseMin(b) - room, a.cwiseMax(b) + room}, [&](int v, const auto& at) {
      if (v == edge.first || v == edge.second) return;
      const Vector3d to_v = at - a;
      const double s = to_v.dot(along) / length;
      if (s <= 0 || s >= length || (to_v - along * (s / length)).norm() > tolerance_) return;
      found.emplace_back(s, v);
    });
    std::sort(found.begin(), found.end());
    std::vector<int> vertices;
    for (const auto& [s, v] : found) vertices.push_back(v);
    return vertices;
  }

  static void append(const Eigen::Vector3i& triangle, const Insides& inside,
                     std::vector<Eigen::Vector3i>& divided) {
    std::array<Side, 3> sides;
    for (int k = 0; k < 3; ++k) {
      Side& side = sides[static_cast<std::size_t>(k)];
      side.from = triangle[k];
      const Edge edge(triangle[k], triangle[(k + 1) % 3]);
      const auto found = std::partition_point(inside.begin(), inside.end(),
                                              [&](const auto& on) { return on.first < edge; });
      if (found == inside.end() || found->first != edge) continue;
      for (const int v : found->second) {
        if (v != triangle[(k + 2) % 3]) side.between.push_back(v);  // its own, if it is flat
      }
    }
    divide(sides, divided);
  }

  // At the middle one of the vertices on a side, towards the corner across from it: no part is
  // flatter than the triangle.
  static void divide(std::array<Side, 3> sides, std::vector<Eigen::Vector3i>& divided) {
    for (int turn = 0; turn < 3 && sides[0].between.empty(); ++turn)
      std::rotate(sides.begin(), sides.begin() + 1, sides.end());
    const std::vector<int>& between = sides[0].between;
    if (between.empty()) {
      divided.emplace_back(sides[0].from, sides[1].from, sides[2].from);
      return;
    }
    const auto middle = between.begin() + static_cast<std::ptrdiff_t>(between.size() / 2);
    const Side first{sides[0].from, {between.begin(), middle}};
    const Side second{*middle, {middle + 1, between.end()}};
    divide({first, Side{*middle, {}}, sides[2]}, divided);
    divide({second, sides[1], Side{sides[2].from, {}}}, divided);
  }

  double tolerance_;
  std::vector<Vector3d> points_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace

TriangleMesh withoutCracks(const TriangleMesh& mesh, double tolerance) {
  constexpr int kMostRounds = 8;
  CrackMender mender(mesh, tolerance);
  for (int round = 0; round < kMostRounds; ++round) {
    if (!mender.divideOnce()) break;
  }
  return mender.mesh();
}

namespace {

/// The side of a triangle from corner k to k + 1 that is longest.
int longestSide(const TriangleMesh& mesh, Eigen::Index t) {
  int longest = 0;
  for (int k = 1; k < 3; ++k) {
    const auto length = [&](int side) {
      return (mesh.corner(t, (side + 1) % 3) - mesh.corner(t, side)).norm();
    };
    if (length(k) > length(longest)) longest = k;
  }
  return longest;
}

/// One round over the flat triangles of a mesh.
class FlatFlipper {
 public:
  explicit FlatFlipper(TriangleMesh& mesh) : mesh_(mesh), edges_(computeMeshEdges(mesh)) {
    for (const EdgeGroup& group : edges_.edges) {
      const HalfEdge& half_edge = edges_.half_edges[group.first];
      vertex_pairs_.insert({half_edge.low, half_edge.high});
    }
    was_changed_.assign(mesh.triangleCount(), false);
  }

  /// Returns how many were mended.
  int flipAll() {
    int count = 0;
    for (const auto& [p, q] : edgePairs(edges_)) {
      if (isFlatAcross(p)) {
        count += static_cast<int>(flip(p, q));
      } else if (isFlatAcross(q)) {
        count += static_cast<int>(flip(q, p));
      }
    }
    return count;
  }

 private:
  bool isFlatAcross(const HalfEdge& edge) const {
    return !was_changed_[edge.triangle] && heightRatio(mesh_, edge.triangle) < kLeastHeight &&
           longestSide(mesh_, edge.triangle) == edge.side;
  }

  // The flat triangle a b c and its neighbour p q d, a b being p q or q p, become p c d and c q d,
  // the way round that the neighbour has.
  bool flip(const HalfEdge& flat, const HalfEdge& neighbour) {
    if (was_changed_[neighbour.triangle]) return false;
    const int c = mesh_.triangles((flat.side + 2) % 3, flat.triangle);
    const int p = mesh_.triangles(neighbour.side, neighbour.triangle);
    const int q = mesh_.triangles((neighbour.side + 1) % 3, neighbour.triangle);
    const int d = mesh_.triangles((neighbour.side + 2) % 3, neighbour.triangle);
    if (c == d || !vertex_pairs_.insert({std::min(c, d), std::max(c, d)}).second) return false;
    mesh_.triangles.col(flat.triangle) << p, c, d;
    mesh_.triangles.col(neighbour.triangle) << c, q, d;
    was_changed_[flat.triangle] = was_changed_[neighbour.triangle] = true;
    return true;
  }

  TriangleMesh& mesh_;
  MeshEdges edges_;
  std::set<std::pair<int, int>> vertex_pairs_;
  std::vector<bool> was_changed_;
};

bool hasBoundary(const TriangleMesh& mesh) {
  const std::vector<EdgeGroup> edges = computeMeshEdges(mesh).edges;
  return std::any_of(edges.begin(), edges.end(),
                     [](const EdgeGroup& edge) { return edge.size() == 1; });
}

/// True if the corners of a triangle are an even permutation of the sorted ones.
bool isEven(const TriangleMesh& mesh, const SortedTriangle& t) {
  const auto corners = mesh.triangles.col(t.triangle);
  return (corners[0] == t.corners[0] && corners[1] == t.corners[1]) ||
         (corners[1] == t.corners[0] && corners[2] == t.corners[1]) ||
         (corners[2] == t.corners[0] && corners[0] == t.corners[1]);
}

bool hasFlatTriangle(const TriangleMesh& mesh) {
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    if (heightRatio(mesh, t) < kLeastHeight) return true;
  return false;
}

}  // namespace

double heightRatio(const TriangleMesh& mesh, Eigen::Index triangle) {
  const Eigen::Vector3d a = mesh.corner(triangle, 0), b = mesh.corner(triangle, 1),
                        c = mesh.corner(triangle, 2);
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  // The edges are scaled to 1 first: the square of a tiny length may not be a number.
  return longest > 0 ? ((b - a) / longest).cross((c - a) / longest).norm() : 0.0;
}

CheckedMesh withoutCopies(const TriangleMesh& mesh, const std::string& name) {
  CheckedMesh result{mesh, {}};
  const std::vector<SortedTriangle> entries = sortedByCorners(mesh);
  if (entries.size() % 2 != 0) return result;
  std::vector<Eigen::Index> kept;
  for (std::size_t i = 0; i < entries.size(); i += 2) {
    if (entries[i].corners != entries[i + 1].corners) return result;
    if (!kept.empty() && entries[i].corners == entries[i - 1].corners) return result;
    kept.push_back(entries[i].triangle);
  }
  std::sort(kept.begin(), kept.end());
  for (std::size_t i = 0; i < kept.size(); ++i)
    result.mesh.triangles.col(static_cast<Eigen::Index>(i)) = mesh.triangles.col(kept[i]);
  result.mesh.triangles.conservativeResize(3, static_cast<Eigen::Index>(kept.size()));
  result.warnings.push_back(name + ": every triangle stands twice, one copy of each was left out");
  return result;
}

CheckedMesh withoutFolds(const TriangleMesh& mesh, const std::string& name) {
  const std::vector<SortedTriangle> entries = sortedByCorners(mesh);
  std::map<std::pair<int, int>, int> users;  // triangles at an edge, by its ends
  for (const auto& [corners, triangle] : entries)
    for (const auto& [low, high] : {std::pair(0, 1), std::pair(1, 2), std::pair(0, 2)})
      ++users[{corners[low], corners[high]}];
  const auto has_own_edge = [&](const std::array<int, 3>& c) {
    return users[{c[0], c[1]}] == 2 || users[{c[1], c[2]}] == 2 || users[{c[0], c[2]}] == 2;
  };
  const auto is_fold = [&](std::size_t i) {  // entries i and i + 1
    return i + 1 < entries.size() && entries[i].corners == entries[i + 1].corners &&
           isEven(mesh, entries[i]) != isEven(mesh, entries[i + 1]) &&
           has_own_edge(entries[i].corners);
  };
  std::vector<int> kept;
  int folds = 0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (is_fold(i)) {
      ++folds;
      ++i;
    } else {
      kept.push_back(entries[i].triangle);
    }
  }
  if (folds == 0 || kept.empty()) return {mesh, {}};
  std::sort(kept.begin(), kept.end());
  CheckedMesh result{mesh, {}};
  result.mesh.triangles = mesh.triangles(Eigen::all, kept);
  result.warnings.push_back(
      name +
      ": folds, opposite triangles on the same corners, were left out: " + std::to_string(folds));
  return result;
}

CheckedMesh withoutFlatTriangles(const TriangleMesh& mesh, const std::string& name) {
  CheckedMesh result{mesh, {}};
  constexpr int kMostRounds = 64;  // two flat neighbours could take turns
  int count = 0;
  for (int round = 0; round < kMostRounds && hasFlatTriangle(result.mesh); ++round) {
    const int mended = FlatFlipper(result.mesh).flipAll();
    if (mended == 0) break;
    count += mended;
  }
  if (count > 0) {
    result.warnings.push_back(name + ": " + std::to_string(count) +
                              " flat triangles were joined to their neighbours");
  }
  return result;
}

CheckedMesh withoutTJunctions(const TriangleMesh& mesh, const std::string& name) {
  constexpr double kOnEdge = 1e-6;  // as vertices are welded
  if (!hasBoundary(mesh)) return {mesh, {}};
  TriangleMesh divided = withoutCracks(mesh, kOnEdge * mesh.extents().norm());
  if (hasBoundary(divided)) return {mesh, {}};
  const auto more = std::to_string(divided.triangleCount() - mesh.triangleCount());
  return {std::move(divided),
          {name +
           ": vertices lie on edges of other triangles (T-junctions), which were divided "
           "there; triangles added: " +
           more}};
}

}  // namespace ambient
