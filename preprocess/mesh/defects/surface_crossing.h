#pragma once

#include <optional>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Signed solid angle [sr] of a triangle seen from `point`, in [-2 pi, 2 pi]; positive if the
/// triangle shows its back, as a closed outward surface does to a point inside. 0 in the triangle's
/// plane outside of it. Van Oosterom and Strackee 1983.
double solidAngle(const TriangleMesh& mesh, Eigen::Index triangle, const Eigen::Vector3d& point);

/// Sum of the solid angles of all triangles: 4 pi inside a closed outward surface, 0 outside.
double solidAngle(const TriangleMesh& mesh, const Eigen::Vector3d& point);

/// Volume [m^3] of the points around which the triangles wind more than half, whether or not they
/// are closed; what several surfaces enclose counts once (Jacobson, Kavan and Sorkine-Hornung
/// 2013). Samples 8^3 to 24^3 points of the bounding box, fewer for many triangles; accuracy some
/// per cent. Cost 512 T solid angles, or 2e8 if that is more.
double enclosedVolume(const TriangleMesh& mesh);

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
