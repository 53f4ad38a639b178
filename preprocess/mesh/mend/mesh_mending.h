#pragma once

#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Closes cracks: where a vertex of one triangle lies on an edge of another one, within the
/// tolerance [m], the other one is divided there, until every edge has a partner or nothing helps.
/// Only edges without a partner are looked at. Cost O(T log T + E V) for E such edges with V ends
/// between their own, in x.
TriangleMesh withoutCracks(const TriangleMesh& mesh, double tolerance);

/// Height of a triangle over its longest edge below which its normal is noise: the resolution of
/// single-precision coordinates.
constexpr double kLeastHeight = 1e-7;

/// Height of a triangle over its longest edge; 0 if it is a point.
double heightRatio(const TriangleMesh& mesh, Eigen::Index triangle);

/// If every triangle of a mesh exists exactly twice, in either orientation, removes the second
/// copies, with a warning. Returns any other mesh unchanged. Cost O(T log T).
/// @pre indices are in range.
CheckedMesh withoutCopies(const TriangleMesh& mesh, const std::string& name);

/// Removes folds, pairs of triangles on the same corners that look in opposite directions and have
/// an edge for themselves, with a warning: a quadrilateral with two equal corners leaves one. Edges
/// beside them keep their two triangles. A mesh of nothing else stays as it is. Cost O(T log T).
/// @pre indices are in range.
CheckedMesh withoutFolds(const TriangleMesh& mesh, const std::string& name);

/// Mends flat triangles (height below kLeastHeight of the longest edge) by an edge flip: a flat
/// triangle and its one neighbour across the longest edge are divided along the other diagonal,
/// which opens no hole. Adds a warning. Triangles that cannot be mended so stay. Cost O(T log T)
/// for each round; a round mends all flat triangles that are not neighbours.
/// @pre indices are in range, coordinates finite.
CheckedMesh withoutFlatTriangles(const TriangleMesh& mesh, const std::string& name);

/// If all boundary edges of a mesh are T-junctions (a vertex lies on the edge of another triangle
/// within 1e-6 of the size), divides triangles there and adds a warning. Returns any other mesh
/// unchanged. Cost: that of withoutCracks().
/// @pre indices are in range, coordinates finite.
CheckedMesh withoutTJunctions(const TriangleMesh& mesh, const std::string& name);

}  // namespace ambient
