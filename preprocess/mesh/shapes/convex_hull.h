#pragma once

#include <string>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Bits of the lattice for hulls of points that are known to the rounding of a float only: points
/// closer to the hull than 2^-14 of its extent may be left out, and no side is thinner than that.
constexpr int kCoarseHullBits = 14;

/// Computes the convex hull of points [m], triangles outward; vertices are points of the list.
/// Points are rounded to 2^-bits of the extent along each axis; sides of planes are then computed
/// exactly, so that the hull is always closed. Expected cost O(n log n) (Barber, Dobkin and
/// Huhdanpaa, "The quickhull algorithm for convex hulls", 1996).
/// @pre bits <= 30
/// @throws std::runtime_error in one line that begins with `name`: fewer than 4 points, a
/// coordinate that is not finite, points in a plane.
TriangleMesh makeConvexHull(const Eigen::Matrix3Xd& points, const std::string& name, int bits = 30);

}  // namespace ambient
