#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// True if the segment from p to q meets the inside of a triangle; false for segments in its plane.
bool crossesTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const TriangleMesh& mesh,
                     Eigen::Index triangle);

/// Computes the distance of a point from a triangle [m].
double distanceToTriangle(const Eigen::Vector3d& point, const TriangleMesh& mesh,
                          Eigen::Index triangle);

/// Computes the point of a triangle (one corner per column) that is nearest to `point` [m].
/// @pre the triangle has an area.
Eigen::Vector3d nearestPoint(const Eigen::Matrix3d& triangle, const Eigen::Vector3d& point);

}  // namespace ambient
