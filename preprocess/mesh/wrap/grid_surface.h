#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

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

/// Makes the surface between the nodes of a grid that lie inside a surface, which need not be
/// closed, or near its thin parts, and the other nodes: closed, manifold and
/// outward (Ju, Losasso, Schaefer and Warren, "Dual contouring of Hermite data", 2002). Each cube
/// with nodes of both kinds gets one vertex, where the planes of the mesh at the cube's edges come
/// closest to each other; so sharp edges and corners stay sharp. Each edge between nodes of both
/// kinds gets two triangles. Cost O(nodes + T + A / step^2).
/// @pre coordinates are finite, and the mesh lies inside the grid.
TriangleMesh makeGridSurface(const TriangleMesh& mesh, const CubicGrid& grid);

}  // namespace ambient
