#pragma once

#include <optional>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// True if the segment from p to q meets the inside of a triangle; false for segments in its plane.
bool crossesTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const TriangleMesh& mesh,
                     Eigen::Index triangle);

/// Numbers of two triangles that meet without a common corner.
struct TrianglePair {
  int first = 0, second = 0;
};

/// One example of each kind of crossing, if there is any.
struct SurfaceCrossings {
  std::optional<TrianglePair> between_parts, within_part;
};

/// Finds where a surface crosses itself, and where separate parts of it cross or come closer to
/// each other than a millionth of its size; `part_of` each triangle. The search ends with the first
/// pair of separate parts. Cost O(T log T) plus the pairs that overlap in one direction, some
/// O(T^1.5) for even meshes.
/// @pre coordinates finite, triangles with an area.
SurfaceCrossings findSurfaceCrossings(const TriangleMesh& mesh, const std::vector<int>& part_of);

}  // namespace ambient
