#pragma once

#include <array>
#include <string>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

// Meshes of simple shapes, centred at the origin, normals outward, vertices on the true surface.
// Every mesh is symmetric under x -> -x, y -> -y and (but for the cone) z -> -z, diagonals
// included, so that entries of the added mass which vanish by symmetry come out as rounding.
// `faces` is the number of triangles aimed at: the result has at most that many.
// All of them throw std::runtime_error if a size is not positive and finite or `faces` is below the
// least number the shape needs, in one line that names the shape, the value and the limit.

/// Ellipsoid with semi-axes [m] along x, y, z: an icosahedral geodesic sphere of frequency n
/// (20 n^2 faces), stretched. At least 20 faces.
TriangleMesh makeEllipsoidMesh(const Eigen::Vector3d& semi_axes, int faces);

/// Box with half sizes [m]; every edge is divided with cosine grading towards its ends, into
/// numbers proportional to the root of its length so that cells match across edges. At least 12
/// faces.
TriangleMesh makeBoxMesh(const Eigen::Vector3d& half_sizes, int faces);
/// Makes a box with given numbers of divisions of the edges along x, y, z.
/// @pre they are even, or all 1
TriangleMesh makeBoxMesh(const Eigen::Vector3d& half_sizes, const std::array<int, 3>& divisions);

/// Circular cylinder about z, radius and full height [m], graded towards the rims. At least 48
/// faces, slender ones up to 304.
TriangleMesh makeCylinderMesh(double radius, double height, int faces);

/// Capsule about z: radius and height of the cylindrical part [m], as btCapsuleShapeZ. At least 48
/// faces, slender ones up to 304.
TriangleMesh makeCapsuleMesh(double radius, double height, int faces);

/// Cone about z, apex at +height/2, base at -height/2 [m], graded towards the rim. At least 16
/// faces, slender ones up to 320.
TriangleMesh makeConeMesh(double radius, double height, int faces);

/// Flat sheets of zero thickness in the x-y plane, normal +z, graded towards the boundary. No
/// triangle has all corners on the boundary, where a sheet carries no potential jump. At least 8
/// faces.
TriangleMesh makeRectangularSheetMesh(double size_x, double size_y, int faces);
TriangleMesh makeEllipticSheetMesh(double semi_axis_x, double semi_axis_y, int faces);

/// Refuses a size that is not positive and finite.
/// @throws std::runtime_error naming the shape, the size and its value.
void requirePositiveSize(const std::string& shape, const std::string& what, double value);

/// Refuses a number of faces below the least one the shape can be made of, or above 1 000 000.
/// @throws std::runtime_error naming the shape, the number and the limit.
void requireFaces(const std::string& shape, int faces, int least);

/// Least number of triangles of makeCylinderMesh(), makeCapsuleMesh() and makeConeMesh(); larger
/// for slender shapes.
int leastCylinderFaces(double radius, double height);
int leastCapsuleFaces(double radius, double height);
int leastConeFaces(double radius, double height);

}  // namespace ambient
