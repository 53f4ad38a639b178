#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>

#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

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
  GridCrossings(const TriangleMesh& mesh, const CubicGrid& grid);

  /// Returns the crossings between a node and the next one along an axis; null: none.
  const LineCrossings* find(std::int64_t node, int axis) const {
    const auto found = on_line_.find(3 * node + axis);
    return found == on_line_.end() ? nullptr : &found->second;
  }

 private:
  void addTriangle(const TriangleMesh& mesh, int triangle);
  void addOpenEdge(const TriangleMesh& mesh, int triangle, int side);
  void add(std::int64_t line, const LineCrossing& crossing, bool is_gap);

  CubicGrid grid_;
  std::unordered_map<std::int64_t, LineCrossings> on_line_;
};

}  // namespace ambient
