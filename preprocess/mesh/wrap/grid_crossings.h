#pragma once

#include <unordered_map>

#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/wrap/cubic_grid.h"

namespace ambient {

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
