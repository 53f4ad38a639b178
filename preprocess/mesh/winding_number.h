#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Signed solid angle [sr] of a triangle seen from `point`, in [-2 pi, 2 pi]; positive if the
/// triangle shows its back, as a closed outward surface does to a point inside. 0 in the triangle's
/// plane outside of it. Van Oosterom and Strackee 1983.
double solidAngle(const TriangleMesh& mesh, Eigen::Index triangle, const Eigen::Vector3d& point);

}  // namespace ambient
