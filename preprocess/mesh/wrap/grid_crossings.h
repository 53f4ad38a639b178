#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Nodes at the corners of equal cubes, numbered with x fastest.
struct CubicGrid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< place of node 0 [m]
  double step = 1;                                   ///< side of a cube [m]
  std::array<std::int64_t, 3> counts{};              ///< numbers of nodes along the axes

  std::int64_t nodeCount() const { return counts[0] * counts[1] * counts[2]; }
  /// Difference of numbers from a node to the next one along an axis.
  std::int64_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? counts[0] : counts[0] * counts[1];
  }
  std::int64_t nodeAt(const std::array<std::int64_t, 3>& place) const {
    return place[0] + counts[0] * (place[1] + counts[1] * place[2]);
  }
  std::array<std::int64_t, 3> placeOf(std::int64_t node) const {
    return {node % counts[0], node / counts[0] % counts[1], node / (counts[0] * counts[1])};
  }
  Eigen::Vector3d pointOf(std::int64_t node) const {
    const auto place = placeOf(node);
    return origin + step * Eigen::Vector3d(static_cast<double>(place[0]),
                                           static_cast<double>(place[1]),
                                           static_cast<double>(place[2]));
  }
  /// Converts a point [m] to steps from node 0.
  Eigen::Vector3d inSteps(const Eigen::Vector3d& point) const { return (point - origin) / step; }
};

inline constexpr double kReach = 0.5;          // of the step, beyond an edge without a partner
inline constexpr double kLongestPiece = 4;     // steps
inline constexpr double kLineRounding = 1e-7;  // steps; no line slips between two triangles
inline constexpr double kLeastSlope = 1e-7;    // of a triangle that a line meets

/// Calls `meet` with every line of the grid along `axis` that passes a box: the node that it passes
/// last before the plane through `on_plane` with that normal, and where it meets it. All in steps.
template <class Meet>
void forEachLine(const CubicGrid& grid, int axis, const Eigen::AlignedBox3d& box,
                 const Eigen::Vector3d& on_plane, const Eigen::Vector3d& normal, const Meet& meet) {
  if (std::abs(normal[axis]) < kLeastSlope) return;
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  const auto first = [&](int i) { return static_cast<std::int64_t>(std::ceil(box.min()[i])); };
  const auto last = [&](int i) { return static_cast<std::int64_t>(std::floor(box.max()[i])); };
  for (std::int64_t u = first(j); u <= last(j); ++u) {
    for (std::int64_t v = first(k); v <= last(k); ++v) {
      Eigen::Vector3d x;
      x[j] = static_cast<double>(u);
      x[k] = static_cast<double>(v);
      x[axis] =
          on_plane[axis] -
          (normal[j] * (x[j] - on_plane[j]) + normal[k] * (x[k] - on_plane[k])) / normal[axis];
      // A steep plane is met within the box, or not here.
      if (!(x[axis] >= box.min()[axis] && x[axis] <= box.max()[axis])) continue;
      std::array<std::int64_t, 3> place{};
      place[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(x[axis]));
      place[static_cast<std::size_t>(j)] = u;
      place[static_cast<std::size_t>(k)] = v;
      meet(grid.nodeAt(place), x);
    }
  }
}

inline Eigen::AlignedBox3d boxAround(const TriangleCorners& points, double reach) {
  const Eigen::Vector3d wider = Eigen::Vector3d::Constant(reach);
  return {points.rowwise().minCoeff() - wider, points.rowwise().maxCoeff() + wider};
}

/// Whether a point of the plane of a triangle is in it, rounding included.
inline bool isIn(const TriangleCorners& triangle, const Eigen::Vector3d& normal,
                 const Eigen::Vector3d& x) {
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d a = triangle.col(k), along = triangle.col((k + 1) % 3) - a;
    if (along.cross(x - a).dot(normal) < -kLineRounding * along.norm()) return false;
  }
  return true;
}

inline TriangleCorners inStepsOf(const CubicGrid& grid, const TriangleMesh& mesh, int t) {
  TriangleCorners corners = cornersOf(mesh, t);
  for (int k = 0; k < 3; ++k) corners.col(k) = grid.inSteps(corners.col(k));
  return corners;
}

inline double fractionOf(double x) { return x - std::floor(x); }

/// Calls `visit` with parts of a triangle whose edges are at most `longest` long, so that they fill
/// their bounding boxes. Cost O(A / longest^2 + L / longest) for an area A and a longest edge L.
template <class Visit>
void forEachPiece(const TriangleCorners& triangle, double longest, const Visit& visit) {
  int side = 0;
  std::array<double, 3> lengths{};
  for (int k = 0; k < 3; ++k) {
    lengths[k] = (triangle.col((k + 1) % 3) - triangle.col(k)).norm();
    if (lengths[k] > lengths[side]) side = k;
  }
  if (!(lengths[side] > longest)) return visit(triangle);
  const Eigen::Vector3d a = triangle.col(side), b = triangle.col((side + 1) % 3),
                        c = triangle.col((side + 2) % 3), middle = (a + b) / 2;
  TriangleCorners half;
  half << a, middle, c;
  forEachPiece(half, longest, visit);
  half << middle, b, c;
  forEachPiece(half, longest, visit);
}

/// Crossing of a surface with the grid line from a node to the next one along an axis.
struct LineCrossing {
  double along = 0;  ///< 0 at the node, 1 at the next one
  int triangle = 0;
};

/// First and last crossing between two nodes.
struct LineCrossings {
  LineCrossing first, last;
  bool is_gap = false;  ///< true: no triangle crosses, but one ends within half a step
};

/// All crossings of the lines of a grid with the triangles of a mesh. Where an edge has no partner,
/// its triangle reaches half a step farther, so that gaps narrower than a step are closed. Cost and
/// memory O(T + A / step^2) for T triangles of area A.
class GridCrossings {
 public:
  /// @pre coordinates are finite, and the mesh lies inside the grid.
  GridCrossings(const TriangleMesh& mesh, const CubicGrid& grid) : grid_(grid) {
    for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) addTriangle(mesh, t);
    const MeshEdges edges = computeMeshEdges(mesh);
    for (const EdgeGroup& edge : edges.edges) {
      if (edge.size() != 1) continue;
      const HalfEdge& side = edges.half_edges[edge.first];
      addOpenEdge(mesh, side.triangle, side.side);
    }
  }

  /// Returns the crossings between a node and the next one along an axis; null: none.
  const LineCrossings* find(std::int64_t node, int axis) const {
    const auto found = on_line_.find(3 * node + axis);
    return found == on_line_.end() ? nullptr : &found->second;
  }

 private:
  void addTriangle(const TriangleMesh& mesh, int triangle) {
    const TriangleCorners corners = inStepsOf(grid_, mesh, triangle);
    const Eigen::Vector3d normal = normalOf(corners);
    forEachPiece(corners, kLongestPiece, [&](const TriangleCorners& piece) {
      for (int axis = 0; axis < 3; ++axis) {
        forEachLine(grid_, axis, boxAround(piece, kLineRounding), piece.col(0), normal,
                    [&](std::int64_t node, const Eigen::Vector3d& x) {
                      if (!isIn(piece, normal, x)) return;
                      add(3 * node + axis, {fractionOf(x[axis]), triangle}, false);
                    });
      }
    });
  }
  void addOpenEdge(const TriangleMesh& mesh, int triangle, int side) {
    const TriangleCorners corners = inStepsOf(grid_, mesh, triangle);
    const Eigen::Vector3d normal = normalOf(corners);
    const Eigen::Vector3d a = corners.col(side), along = corners.col((side + 1) % 3) - a;
    const int count = std::max(1, static_cast<int>(std::ceil(along.norm() / kLongestPiece)));
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d from = a + along * i / count, to = a + along * (i + 1) / count;
      TriangleCorners ends;
      ends << from, to, to;
      for (int axis = 0; axis < 3; ++axis) {
        forEachLine(grid_, axis, boxAround(ends, kReach), from, normal,
                    [&](std::int64_t node, const Eigen::Vector3d& x) {
                      if ((nearestOnSegment(x, from, to) - x).norm() > kReach) return;
                      add(3 * node + axis, {fractionOf(x[axis]), triangle}, true);
                    });
      }
    }
  }
  void add(std::int64_t line, const LineCrossing& crossing, bool is_gap) {
    const auto [entry, is_new] =
        on_line_.try_emplace(line, LineCrossings{crossing, crossing, is_gap});
    if (is_new) return;
    LineCrossings& found = entry->second;
    if (found.is_gap && !is_gap) {
      found = {crossing, crossing, false};
    } else if (found.is_gap == is_gap) {
      if (crossing.along < found.first.along) found.first = crossing;
      if (crossing.along > found.last.along) found.last = crossing;
    }
  }

  CubicGrid grid_;
  std::unordered_map<std::int64_t, LineCrossings> on_line_;
};

}  // namespace ambient
