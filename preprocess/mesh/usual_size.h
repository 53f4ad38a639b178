#pragma once

#include <string>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Far beyond these sizes areas, volumes and moments leave the range of a double [m].
constexpr double kSmallestSize = 1e-9, kLargestSize = 1e9;

/// Checks that a mesh has a size that can be computed with: neither tiny nor huge, and so wide and
/// thick that its triangles have normals. Cost O(T).
/// @throws std::runtime_error in one line that begins with `source`, if its diagonal is not
/// kSmallestSize to kLargestSize, its area over the diagonal's square is below 1e-12 or, unless it
/// is a sheet, its volume over its area^1.5 below 1e-6.
void requireUsualSize(const TriangleMesh& mesh, bool sheet, const std::string& source);

/// "1 x 2 x 3 m"
std::string extentsText(const Eigen::Vector3d& extents);

/// One line that begins with `source`, if the longest extent is above 10 m or below 1 mm: a
/// mesh in millimetres looks like that. Else empty.
std::string unlikelySizeWarning(const TriangleMesh& mesh, const std::string& source);

}  // namespace ambient
