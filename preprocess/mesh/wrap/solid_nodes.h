#pragma once

#include <unordered_map>
#include <vector>

#include "preprocess/mesh/wrap/grid_crossings.h"

namespace ambient {

/// Distance of a node from a thin part of the surface.
struct ThinPart {
  double distance = 0;  ///< [m]
  int triangle = 0;     ///< the nearest one
};

/// The solid nodes of a grid: those around or inside a surface that need not be closed.
struct SolidNodes {
  std::vector<char> is_solid;  ///< per node
  /// Nodes near thin parts of the surface that the surface itself does not enclose, by number.
  std::unordered_map<std::int64_t, ThinPart> thin;
};

/// Half the thickness that thin parts get, over the step of the grid: a line of the grid that
/// crosses them has a node in them.
constexpr double kThinReach = 0.75;

/// Solid is what cannot be reached from outside along lines of the grid without crossing the
/// surface or a gap narrower than a step, and what comes closer than kThinReach steps to parts of
/// the surface that enclose no node: sheets, plates and rods thinner than the grid resolves, open
/// shells. Nodes are added until solid and fluid touch nowhere in an edge or a corner alone, and no
/// fluid is enclosed, so that every cube of the grid holds one piece of the boundary at most. Cost
/// O(nodes + T + A / step^2).
SolidNodes findSolidNodes(const TriangleMesh& mesh, const CubicGrid& grid,
                          const GridCrossings& crossings);

}  // namespace ambient
