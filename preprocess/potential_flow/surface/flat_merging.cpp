#include "preprocess/potential_flow/surface/flat_merging.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/editable_mesh.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/surface/panel_surface.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr double kClearlyMore = 1e-6;    // than half a turn [rad]; among equal diagonals none flips
constexpr double kGoodShape = 0.05;      // height over longest edge
constexpr double kMostWorsening = 0.5;   // of the least one around, else
constexpr std::size_t kMostAround = 32;  // triangles at a vertex: more cost too much

/// The third corner.
int apexOf(const Eigen::Vector3i& t, int a, int b) { return t.sum() - a - b; }

double angleAt(const Vector3d& apex, const Vector3d& a, const Vector3d& b) {
  return portable::atan2((a - apex).cross(b - apex).norm(), (a - apex).dot(b - apex));
}

/// A manifold mesh whose edges are flipped and contracted where that leaves its surface in place.
class FlatMerger : private EditableMesh {
 public:
  /// @param tolerance how far off a plane points may be to lie in it [m]
  FlatMerger(const TriangleMesh& mesh, double tolerance)
      : EditableMesh(mesh), tolerance_(tolerance) {}

  /// Removes vertices inside flat parts, on straight edges between two of them, and on straight
  /// boundaries, one pass over all; returns how many.
  /// @param highest_shape only vertices with a triangle of at most that height over longest edge
  int contractFlatVertices(double highest_shape) {
    int count = 0;
    for (int v = 0; v < static_cast<int>(around.size()); ++v) {
      double worst = 1;
      for (const int t : around[v]) worst = std::min(worst, shapeOf(triangles[t]));
      if (worst > highest_shape) continue;
      double best = -1;
      int target = -1;
      for (const int candidate : contractionTargets(v)) {
        const double quality = qualityAfterContraction(v, candidate);
        if (quality <= best) continue;
        best = quality;
        target = candidate;
      }
      if (target < 0 || best < std::min(kGoodShape, kMostWorsening * worst)) continue;
      contract(v, target);
      ++count;
    }
    return count;
  }

  /// Flips edges between coplanar triangles until opposite angles sum to at most half a turn
  /// (Delaunay 1934; Lawson 1977); returns how many.
  int flipFlatEdges() {
    std::vector<std::array<int, 2>> stack;
    const auto pushEdgesOf = [&](const Corners& t) {
      for (int k = 0; k < 3; ++k) stack.push_back({t[k], t[(k + 1) % 3]});
    };
    for (auto t = triangles.rbegin(); t != triangles.rend(); ++t)
      if ((*t)[0] >= 0) pushEdgesOf(*t);
    int count = 0;
    // Ends by itself in a plane; rounding shall not make it run for ever.
    const std::size_t most = 20 * triangles.size();
    while (!stack.empty() && static_cast<std::size_t>(count) < most) {
      const auto [a, b] = stack.back();
      stack.pop_back();
      const std::vector<int> sides = trianglesAt(a, b);
      if (sides.size() != 2 || !flip(a, b)) continue;
      ++count;
      for (const int t : sides) pushEdgesOf(triangles[t]);
    }
    return count;
  }

  /// True if triangles that are not coplanar, or two edges at which the surface bends or ends, meet
  /// at an angle smaller than that of `sharp_cosine`: the mesh approximates something round.
  bool hasSmoothBends(double sharp_cosine) const {
    std::vector<std::vector<Vector3d>> bends(around.size());  // away from the vertex, unit
    for (const Corners& corners : triangles)
      for (int k = 0; k < 3 && corners[0] >= 0; ++k) {
        const int a = corners[k], b = corners[(k + 1) % 3];
        const std::vector<int> sides = trianglesAt(a, b);
        if (sides.size() == 2 && (a > b || areCoplanar(sides[0], sides[1]))) continue;
        if (sides.size() == 2 && cosineBetween(sides[0], sides[1]) > sharp_cosine) return true;
        const Vector3d along = (point(b) - point(a)).normalized();
        bends[a].push_back(along);
        bends[b].push_back(-along);
      }
    return std::any_of(bends.begin(), bends.end(), [&](const std::vector<Vector3d>& at_vertex) {
      return at_vertex.size() == 2 && -at_vertex[0].dot(at_vertex[1]) > sharp_cosine;
    });
  }

  /// Returns the present triangles; keeps vertices without a triangle.
  TriangleMesh mesh() const { return makeTriangleMesh(vertices, trianglesLeft()); }

 private:
  bool isInPlaneOf(const Corners& t, int vertex) const {
    return std::abs(crossOf(t).normalized().dot(point(vertex) - point(t[0]))) <= tolerance_;
  }

  /// Returns the cosine of the angle between the normals of two triangles.
  double cosineBetween(int t, int s) const {
    return crossOf(triangles[t]).normalized().dot(crossOf(triangles[s]).normalized());
  }

  bool areCoplanar(int t, int s) const {
    const Corners &p = triangles[t], &q = triangles[s];
    if (crossOf(p).dot(crossOf(q)) <= 0) return false;
    // The plane of a sliver is known only near it: its apex must lie in the other's.
    const auto liesIn = [&](const Corners& one, const Corners& plane) {
      for (int k = 0; k < 3; ++k)
        if (!holds(plane, one[k])) return isInPlaneOf(plane, one[k]);
      return false;
    };
    return liesIn(p, q) || liesIn(q, p);
  }

  /// Returns the neighbours to which a vertex can be moved without changing the surface, folds
  /// aside.
  std::vector<int> contractionTargets(int v) const {
    if (around[v].size() > kMostAround) return {};
    std::vector<int> bent;
    std::vector<int> neighbours = neighboursOf(v);
    for (const int n : neighbours) {
      const std::vector<int> sides = trianglesAt(v, n);
      if (sides.size() != 2 || !areCoplanar(sides[0], sides[1])) bent.push_back(n);
      if (bent.size() > 2) return {};
    }
    if (bent.empty()) return neighbours;
    if (bent.size() != 2) return {};
    const Vector3d a = point(bent[0]) - point(v), b = point(bent[1]) - point(v);
    const bool straight = a.dot(b) < 0 && a.cross(b).norm() <= tolerance_ * (a - b).norm();
    return straight ? bent : std::vector<int>();
  }

  /// Least height over longest edge of the remaining triangles after a contraction; below 0: not
  /// allowed.
  double qualityAfterContraction(int v, int target) const {
    if (around[v].size() + around[target].size() > kMostAround) return -1;
    if (commonNeighbours(v, target) != trianglesAt(v, target).size()) return -1;
    double worst = 1;
    for (const int t : around[v]) {
      if (holds(triangles[t], target)) continue;
      Corners moved = triangles[t];
      std::replace(moved.data(), moved.data() + 3, v, target);
      if (crossOf(moved).dot(crossOf(triangles[t])) <= 0 || !isInPlaneOf(moved, v)) return -1;
      worst = std::min(worst, shapeOf(moved));
    }
    return worst;
  }

  /// @pre the edge has two triangles.
  bool flip(int a, int b) {
    const std::vector<int> sides = trianglesAt(a, b);
    AMBIENT_ASSERT(sides.size() == 2);
    if (!areCoplanar(sides[0], sides[1])) return false;
    int t = sides[0], s = sides[1];
    // t runs from a to b.
    const Corners& first = triangles[t];
    for (int k = 0; k < 3; ++k)
      if (first[k] == b && first[(k + 1) % 3] == a) std::swap(t, s);
    const int c = apexOf(triangles[t], a, b), d = apexOf(triangles[s], a, b);
    const double angles =
        angleAt(point(c), point(a), point(b)) + angleAt(point(d), point(a), point(b));
    if (angles <= kPi + kClearlyMore || !trianglesAt(c, d).empty()) return false;
    const Corners at_a(a, d, c), at_b(d, b, c);
    const Vector3d normal = crossOf(triangles[t]) + crossOf(triangles[s]);
    if (crossOf(at_a).dot(normal) <= 0 || crossOf(at_b).dot(normal) <= 0) return false;
    const auto leave = [&](int vertex, int triangle) {
      std::vector<int>& list = around[vertex];
      list.erase(std::find(list.begin(), list.end(), triangle));
    };
    leave(b, t);
    leave(a, s);
    around[d].push_back(t);
    around[c].push_back(s);
    triangles[t] = at_a;
    triangles[s] = at_b;
    return true;
  }

  double tolerance_;
};

constexpr double kFlat = 1e-7;    // of the size; more than the rounding of single precision
constexpr double kSkinny = 50;    // longest edge over height; graded meshes stay below
constexpr int kLeastPanels = 20;  // per large triangle, to resolve its edges

FlatMerger merged(const TriangleMesh& mesh, double highest_shape) {
  FlatMerger result(mesh, kFlat * mesh.extents().norm());
  result.flipFlatEdges();
  while (result.contractFlatVertices(highest_shape) > 0) result.flipFlatEdges();
  return result;
}

}  // namespace

TriangleMesh mergeFlatTriangles(const TriangleMesh& mesh, bool sheet, int max_panels) {
  if (max_panels <= 0 || mesh.triangleCount() == 0) return mesh;
  if (!sheet && !estimateBulges(mesh).empty()) return mesh;
  const FlatMerger large = merged(mesh, 1);
  // Round parts keep the grading that they came with.
  if (!large.hasSmoothBends(kSharpCosine)) {
    TriangleMesh result = large.mesh();
    if (kLeastPanels * result.triangleCount() <= max_panels) return result;
  }
  const bool skinny = findWorstTriangles(mesh, 1).front().aspect > kSkinny;
  return skinny ? merged(mesh, 1 / kSkinny).mesh() : mesh;
}

TriangleMesh mergePolyhedronSides(const TriangleMesh& mesh) { return merged(mesh, 1).mesh(); }

}  // namespace ambient
