#pragma once

#include <unordered_map>
#include <vector>

#include "preprocess/mesh/wrap/grid_crossings.h"

namespace ambient {

/// Distance of a node from a thin part of the surface.
struct ThinPart {
  double distance = 0;  ///< [m]
  int triangle = 0;     ///< nearest triangle
};

/// Solid nodes of a grid: nodes inside a surface that need not be closed, or near it.
struct SolidNodes {
  std::vector<char> is_solid;  ///< per node
  /// Nodes near thin parts of the surface that the surface itself does not enclose, by number.
  std::unordered_map<std::int64_t, ThinPart> thin;
};

/// Half of the thickness that thin parts get, over the step of the grid [1]; so thick that each
/// grid line through a thin part has a node in it.
constexpr double kThinReach = 0.75;

/// Finds the solid nodes. A node is solid if it cannot be reached from outside along grid lines
/// without crossing the surface or a gap narrower than a step. It is also solid if it is closer
/// than kThinReach steps to parts of the surface that enclose no node: sheets, plates and rods
/// thinner than the grid resolves, open shells. Nodes are added until solid and fluid touch nowhere
/// in an edge or a corner alone, and no fluid is enclosed, so that every cube of the grid holds one
/// piece of the boundary at most. Cost O(nodes + T + A / step^2).
SolidNodes findSolidNodes(const TriangleMesh& mesh, const CubicGrid& grid,
                          const GridCrossings& crossings);

}  // namespace ambient
