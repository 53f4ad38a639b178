#pragma once

#include <string>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Smallest and largest size of a mesh [m]. Far beyond them, areas, volumes and moments leave the
/// range of a double.
constexpr double kSmallestSize = 1e-9, kLargestSize = 1e9;

/// Volume over area^1.5 below which a surface encloses nothing; a square plate reaches it at a
/// thickness of 3e-6 of its side, where single-precision coordinates end. A sphere has 0.094.
constexpr double kLeastVolume = 1e-6;

/// Checks that a mesh is neither tiny nor huge, and wide and thick enough for its triangles to have
/// normals. Cost O(T).
/// @throws std::runtime_error in one line that begins with `source`, if its diagonal is not
/// kSmallestSize to kLargestSize, its area over the diagonal's square is below 1e-12 or, unless it
/// is a sheet, its volume over its area^1.5 below kLeastVolume.
void requireUsualSize(const TriangleMesh& mesh, bool sheet, const std::string& source);

/// Text of extents [m]: "1 x 2 x 3 m".
std::string extentsText(const Eigen::Vector3d& extents);

/// Returns one line that begins with `source` if the longest extent is above 500 m or below 1 mm,
/// as of a mesh in millimetres; else empty. `is_scaled`: the user has chosen a factor, and knows of
/// large sizes.
std::string unlikelySizeWarning(const TriangleMesh& mesh, bool is_scaled,
                                const std::string& source);

}  // namespace ambient
