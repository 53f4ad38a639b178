#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Signed solid angle [sr] of a triangle seen from `point`, in [-2 pi, 2 pi]; positive if the
/// triangle shows its back, as a closed outward surface does to a point inside. 0 in the triangle's
/// plane outside of it. Van Oosterom and Strackee 1983.
double solidAngle(const TriangleMesh& mesh, Eigen::Index triangle, const Eigen::Vector3d& point);

/// Volume [m^3] of the points around which the triangles wind more than half, whether or not they
/// are closed; what several surfaces enclose counts once (Jacobson, Kavan and Sorkine-Hornung
/// 2013). Samples 8^3 to 24^3 points of the bounding box, fewer for many triangles; accuracy some
/// per cent. Cost 512 T solid angles, or 2e8 if that is more.
double enclosedVolume(const TriangleMesh& mesh);

}  // namespace ambient
