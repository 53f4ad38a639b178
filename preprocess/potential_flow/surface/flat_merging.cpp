#include "preprocess/potential_flow/surface/flat_merging.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/surface/face_bulges.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

/// A manifold mesh whose edges can be flipped and contracted where that leaves its surface in
/// place.
class EditableMesh {
 public:
  /// @param tolerance how far off a plane points may be to lie in it [m]
  EditableMesh(const TriangleMesh& mesh, double tolerance);

  /// Removes vertices inside flat parts, on straight edges between two of them, and on straight
  /// boundaries, one pass over all; returns how many.
  /// @param highest_shape only vertices with a triangle of at most that height over longest edge
  int contractFlatVertices(double highest_shape);

  /// Flips edges between coplanar triangles until opposite angles sum to at most half a turn
  /// (Delaunay 1934; Lawson 1977); returns how many.
  int flipFlatEdges();

  /// True if triangles that are not coplanar, or two edges at which the surface bends or ends, meet
  /// at an angle smaller than that of `sharp_cosine`: the mesh approximates something round.
  bool hasSmoothBends(double sharp_cosine) const;

  /// Returns the present triangles; keeps vertices without a triangle.
  TriangleMesh mesh() const;

 private:
  using Corners = Eigen::Vector3i;

  Eigen::Vector3d point(int v) const { return vertices_.col(v); }
  /// (b - a) x (c - a).
  Eigen::Vector3d crossOf(const Corners& t) const;
  bool isInPlaneOf(const Corners& t, int vertex) const;
  /// Returns the cosine of the angle between the normals of two triangles.
  double cosineBetween(int t, int s) const;
  bool areCoplanar(int t, int s) const;
  /// The triangles at the edge from a to b, at most two.
  std::vector<int> trianglesAt(int a, int b) const;
  std::vector<int> neighboursOf(int v) const;
  /// Returns the neighbours to which a vertex can be moved without changing the surface, folds
  /// aside.
  std::vector<int> contractionTargets(int v) const;
  /// Least height over longest edge of the remaining triangles after a contraction; below 0: not
  /// allowed.
  double qualityAfterContraction(int v, int target) const;
  void contract(int v, int target);
  /// @pre the edge has two triangles.
  bool flip(int a, int b);
  /// Height over longest edge.
  double shapeOf(const Corners& t) const;

  Eigen::Matrix3Xd vertices_;
  std::vector<Corners> triangles_;        ///< -1: removed
  std::vector<std::vector<int>> around_;  ///< per vertex: its triangles
  double tolerance_;
};

using Eigen::Index;
using Eigen::Vector3d;

constexpr double kClearlyMore = 1e-6;    // than half a turn [rad]; among equal diagonals none flips
constexpr double kGoodShape = 0.05;      // height over longest edge
constexpr double kMostWorsening = 0.5;   // of the least one around, else
constexpr std::size_t kMostAround = 32;  // triangles at a vertex: more cost too much

bool holds(const Eigen::Vector3i& t, int v) { return t[0] == v || t[1] == v || t[2] == v; }

/// The third corner.
int apexOf(const Eigen::Vector3i& t, int a, int b) { return t.sum() - a - b; }

double angleAt(const Vector3d& apex, const Vector3d& a, const Vector3d& b) {
  return portable::atan2((a - apex).cross(b - apex).norm(), (a - apex).dot(b - apex));
}

EditableMesh::EditableMesh(const TriangleMesh& mesh, double tolerance)
    : vertices_(mesh.vertices), around_(mesh.vertexCount()), tolerance_(tolerance) {
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    triangles_.emplace_back(mesh.triangles.col(t));
    for (int k = 0; k < 3; ++k) around_[triangles_.back()[k]].push_back(static_cast<int>(t));
  }
}

int EditableMesh::contractFlatVertices(double highest_shape) {
  int count = 0;
  for (int v = 0; v < static_cast<int>(around_.size()); ++v) {
    double worst = 1;
    for (const int t : around_[v]) worst = std::min(worst, shapeOf(triangles_[t]));
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

int EditableMesh::flipFlatEdges() {
  std::vector<std::array<int, 2>> stack;
  const auto pushEdgesOf = [&](const Corners& t) {
    for (int k = 0; k < 3; ++k) stack.push_back({t[k], t[(k + 1) % 3]});
  };
  for (auto t = triangles_.rbegin(); t != triangles_.rend(); ++t)
    if ((*t)[0] >= 0) pushEdgesOf(*t);
  int count = 0;
  // Ends by itself in a plane; rounding shall not make it run for ever.
  const std::size_t most = 20 * triangles_.size();
  while (!stack.empty() && static_cast<std::size_t>(count) < most) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    const std::vector<int> sides = trianglesAt(a, b);
    if (sides.size() != 2 || !flip(a, b)) continue;
    ++count;
    for (const int t : sides) pushEdgesOf(triangles_[t]);
  }
  return count;
}

bool EditableMesh::hasSmoothBends(double sharp_cosine) const {
  std::vector<std::vector<Vector3d>> bends(around_.size());  // away from the vertex, unit
  for (const Corners& corners : triangles_)
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

TriangleMesh EditableMesh::mesh() const {
  TriangleMesh mesh;
  mesh.vertices = vertices_;
  const auto isLeft = [](const Corners& t) { return t[0] >= 0; };
  mesh.triangles.resize(3, std::count_if(triangles_.begin(), triangles_.end(), isLeft));
  Index next = 0;
  for (const Corners& t : triangles_)
    if (isLeft(t)) mesh.triangles.col(next++) = t;
  return mesh;
}

Vector3d EditableMesh::crossOf(const Corners& t) const {
  return (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
}

bool EditableMesh::isInPlaneOf(const Corners& t, int vertex) const {
  return std::abs(crossOf(t).normalized().dot(point(vertex) - point(t[0]))) <= tolerance_;
}

double EditableMesh::cosineBetween(int t, int s) const {
  return crossOf(triangles_[t]).normalized().dot(crossOf(triangles_[s]).normalized());
}

bool EditableMesh::areCoplanar(int t, int s) const {
  const Corners &p = triangles_[t], &q = triangles_[s];
  if (crossOf(p).dot(crossOf(q)) <= 0) return false;
  // The plane of a sliver is known only near it: its apex must lie in the other's.
  const auto liesIn = [&](const Corners& one, const Corners& plane) {
    for (int k = 0; k < 3; ++k)
      if (!holds(plane, one[k])) return isInPlaneOf(plane, one[k]);
    return false;
  };
  return liesIn(p, q) || liesIn(q, p);
}

std::vector<int> EditableMesh::trianglesAt(int a, int b) const {
  const bool fewer_at_b = around_[b].size() < around_[a].size();
  std::vector<int> result;
  for (const int t : around_[fewer_at_b ? b : a])
    if (holds(triangles_[t], fewer_at_b ? a : b)) result.push_back(t);
  return result;
}

std::vector<int> EditableMesh::neighboursOf(int v) const {
  std::vector<int> result;
  for (const int t : around_[v])
    for (int k = 0; k < 3; ++k)
      if (triangles_[t][k] != v) result.push_back(triangles_[t][k]);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<int> EditableMesh::contractionTargets(int v) const {
  if (around_[v].size() > kMostAround) return {};
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

double EditableMesh::shapeOf(const Corners& t) const {
  double longest = 0;  // squared
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (point(t[(k + 1) % 3]) - point(t[k])).squaredNorm());
  return crossOf(t).norm() / longest;
}

double EditableMesh::qualityAfterContraction(int v, int target) const {
  if (around_[v].size() + around_[target].size() > kMostAround) return -1;
  const std::vector<int> of_v = neighboursOf(v), of_target = neighboursOf(target);
  std::vector<int> common;
  std::set_intersection(of_v.begin(), of_v.end(), of_target.begin(), of_target.end(),
                        std::back_inserter(common));
  if (common.size() != trianglesAt(v, target).size()) return -1;
  double worst = 1;
  for (const int t : around_[v]) {
    if (holds(triangles_[t], target)) continue;
    Corners moved = triangles_[t];
    std::replace(moved.data(), moved.data() + 3, v, target);
    if (crossOf(moved).dot(crossOf(triangles_[t])) <= 0 || !isInPlaneOf(moved, v)) return -1;
    worst = std::min(worst, shapeOf(moved));
  }
  return worst;
}

void EditableMesh::contract(int v, int target) {
  for (const int t : around_[v]) {
    Corners& corners = triangles_[t];
    if (holds(corners, target)) {
      for (int k = 0; k < 3; ++k)
        if (corners[k] != v) {
          std::vector<int>& list = around_[corners[k]];
          list.erase(std::find(list.begin(), list.end(), t));
        }
      corners.setConstant(-1);
      continue;
    }
    std::replace(corners.data(), corners.data() + 3, v, target);
    around_[target].push_back(t);
  }
  around_[v].clear();
}

bool EditableMesh::flip(int a, int b) {
  const std::vector<int> sides = trianglesAt(a, b);
  AMBIENT_ASSERT(sides.size() == 2);
  if (!areCoplanar(sides[0], sides[1])) return false;
  int t = sides[0], s = sides[1];
  // t runs from a to b.
  const Corners& first = triangles_[t];
  for (int k = 0; k < 3; ++k)
    if (first[k] == b && first[(k + 1) % 3] == a) std::swap(t, s);
  const int c = apexOf(triangles_[t], a, b), d = apexOf(triangles_[s], a, b);
  const double angles =
      angleAt(point(c), point(a), point(b)) + angleAt(point(d), point(a), point(b));
  if (angles <= kPi + kClearlyMore || !trianglesAt(c, d).empty()) return false;
  const Corners at_a(a, d, c), at_b(d, b, c);
  const Vector3d normal = crossOf(triangles_[t]) + crossOf(triangles_[s]);
  if (crossOf(at_a).dot(normal) <= 0 || crossOf(at_b).dot(normal) <= 0) return false;
  const auto leave = [&](int vertex, int triangle) {
    std::vector<int>& list = around_[vertex];
    list.erase(std::find(list.begin(), list.end(), triangle));
  };
  leave(b, t);
  leave(a, s);
  around_[d].push_back(t);
  around_[c].push_back(s);
  triangles_[t] = at_a;
  triangles_[s] = at_b;
  return true;
}

constexpr double kFlat = 1e-7;    // of the size; more than the rounding of single precision
constexpr double kSkinny = 50;    // longest edge over height; graded meshes stay below
constexpr int kLeastPanels = 20;  // per large triangle, to resolve its edges

EditableMesh merged(const TriangleMesh& mesh, double highest_shape) {
  EditableMesh result(mesh, kFlat * mesh.extents().norm());
  result.flipFlatEdges();
  while (result.contractFlatVertices(highest_shape) > 0) result.flipFlatEdges();
  return result;
}

}  // namespace

TriangleMesh mergeFlatTriangles(const TriangleMesh& mesh, bool sheet, int max_panels) {
  if (max_panels <= 0 || mesh.triangleCount() == 0) return mesh;
  if (!sheet && !estimateBulges(mesh).empty()) return mesh;
  const EditableMesh large = merged(mesh, 1);
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
