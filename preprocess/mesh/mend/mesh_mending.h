#pragma once

#include "preprocess/mesh/checked_mesh.h"

namespace ambient {

/// Height of a triangle over its longest edge below which its normal is noise: the resolution of
/// single-precision coordinates.
constexpr double kLeastHeight = 1e-7;

/// Height of a triangle over its longest edge; 0 if it is a point.
double heightRatio(const TriangleMesh& mesh, Eigen::Index triangle);

/// A mesh in which every triangle stands exactly twice, whichever way round, without the second
/// copies, with a warning; any other mesh as it is. Cost O(T log T).
/// @pre indices are in range.
CheckedMesh withoutCopies(const TriangleMesh& mesh, const std::string& name);

/// Flat triangles (height below kLeastHeight of the longest edge) lose their longest edge to the
/// two edges that run beside it: with the one neighbour across it they are divided along the other
/// diagonal, which opens no hole; with a warning. What that cannot mend stays as it is. Cost
/// O(T log T) for each round; a round mends all flat triangles that are not neighbours.
/// @pre indices are in range, coordinates finite.
CheckedMesh withoutFlatTriangles(const TriangleMesh& mesh, const std::string& name);

/// A mesh whose boundary edges are all T-junctions, where vertices lie on the edges of others
/// within 1e-6 of its size, with the triangles of these divided there, with a warning; any other
/// mesh as it is. Cost that of withoutCracks().
/// @pre indices are in range, coordinates finite.
CheckedMesh withoutTJunctions(const TriangleMesh& mesh, const std::string& name);

}  // namespace ambient
