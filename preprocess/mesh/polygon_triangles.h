#pragma once

#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Divides a simple polygon, convex or not, into n - 2 triangles without new vertices: index
/// triples into `corners` [m], with the orientation of the polygon. The ears of best shape are cut
/// off first, seen along the polygon's area vector. A polygon that crosses itself yields triangles
/// that overlap. Cost O(n^3), n being small.
/// @pre at least three corners, finite.
std::vector<Eigen::Vector3i> dividePolygon(const std::vector<Eigen::Vector3d>& corners);

}  // namespace ambient
