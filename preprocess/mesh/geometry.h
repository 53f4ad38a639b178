#pragma once

#include <set>
#include <utility>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// The corners of a triangle, one per column [m].
using TriangleCorners = Eigen::Matrix3d;

TriangleCorners cornersOf(const TriangleMesh& mesh, Eigen::Index triangle);

/// Unit normal of a triangle, by the right hand; 0 if it has no area.
Eigen::Vector3d normalOf(const TriangleCorners& triangle);

/// Area of a triangle [m^2].
double areaOf(const TriangleMesh& mesh, Eigen::Index triangle);
/// Area of all triangles of a mesh [m^2].
double areaOf(const TriangleMesh& mesh);

/// Volume of the tetrahedron of a point and a triangle, positive if the triangle shows the point
/// its back [m^3].
double tetrahedronVolume(const TriangleMesh& mesh, Eigen::Index triangle,
                         const Eigen::Vector3d& point);
/// Sum of the tetrahedra of a point and all triangles: the volume inside a closed outward surface,
/// whatever the point, but for rounding [m^3].
double tetrahedraVolume(const TriangleMesh& mesh, const Eigen::Vector3d& point);

/// The point between a and b that is nearest to x. @pre a and b differ
Eigen::Vector3d nearestOnSegment(const Eigen::Vector3d& x, const Eigen::Vector3d& a,
                                 const Eigen::Vector3d& b);

/// The point of a triangle that is nearest to x. @pre the triangle has an area.
Eigen::Vector3d nearestPoint(const TriangleCorners& triangle, const Eigen::Vector3d& x);

/// Whether a point is closer to a triangle than a distance [m]. @pre as nearestPoint().
inline bool isCloser(const Eigen::Vector3d& x, const TriangleMesh& mesh, Eigen::Index triangle,
                     double distance) {
  return (nearestPoint(cornersOf(mesh, triangle), x) - x).norm() < distance;
}

/// Bounding box of a triangle along the axes.
Eigen::AlignedBox3d boundsOf(const TriangleMesh& mesh, Eigen::Index triangle);

/// Whether two boxes overlap, or are no farther apart than a gap along each axis [m].
bool areNear(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b, double gap);

/// Divides a simple polygon, convex or not, into n - 2 triangles without new vertices: index
/// triples into `corners` [m], with the orientation of the polygon. The ears of best shape are cut
/// off first, seen along the polygon's area vector. A polygon that crosses itself yields triangles
/// that overlap. Cost O(n^2), of shapes with many hollow corners O(n^3).
/// @param corners at least three, finite [m]
/// @param apart pairs of corners, (low, high), that no new edge joins if there is another way
std::vector<Eigen::Vector3i> dividePolygon(const std::vector<Eigen::Vector3d>& corners,
                                           const std::set<std::pair<int, int>>& apart = {});

/// Deviation of a triangle from an equilateral one.
struct TriangleQuality {
  int triangle = 0;
  double aspect = 0;          ///< longest edge over the height on it; 1.15 at best
  double smallest_angle = 0;  ///< [rad]
  Eigen::Vector3d barycentre = Eigen::Vector3d::Zero();  ///< [m]
};

/// Finds the triangles of largest aspect, worst first. Cost O(T log T).
std::vector<TriangleQuality> findWorstTriangles(const TriangleMesh& mesh, int count);

}  // namespace ambient
