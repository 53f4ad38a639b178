#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Whether the segment from p to q meets the inside of a triangle; segments in its plane do not.
bool crossesTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const TriangleMesh& mesh,
                     Eigen::Index triangle);

/// Distance of a point from a triangle [m].
double distanceToTriangle(const Eigen::Vector3d& point, const TriangleMesh& mesh,
                          Eigen::Index triangle);

}  // namespace ambient
