#pragma once

#include <vector>

#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Triangles of the convex hull of points [m], outward, made by Bullet's btConvexHullComputer; the
/// vertices are points of the list, in double. Points closer to the hull than about 1e-4 of its
/// extent may be left out.
/// @throws std::runtime_error that begins with `name`, for fewer than 4 points, or points in a
/// plane.
TriangleMesh makeHullMesh(const std::vector<Eigen::Vector3d>& points, const std::string& name);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
