#pragma once

#include <string>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Triangles of the convex hull of points [m], outward; the vertices are points of the list. Points
/// are rounded to 2^-30 of the largest extent, and which side of a plane they lie on is then exact:
/// no order of the points leaves a hull that is not closed. Expected cost O(n log n) (Barber,
/// Dobkin and Huhdanpaa, "The quickhull algorithm for convex hulls", 1996).
/// @throws std::runtime_error in one line that begins with `name`, if a coordinate is not finite or
/// there are no four points that span a volume.
TriangleMesh makeConvexHull(const Eigen::Matrix3Xd& points, const std::string& name);

}  // namespace ambient
