#pragma once

#include <array>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// The corners of a triangle, one per column.
using TrianglePiece = Eigen::Matrix3d;

/// Calls `visit` with parts of a triangle whose edges are at most `longest` long, so that they fill
/// their bounding boxes. Cost O(A / longest^2 + L / longest) for an area A and a longest edge L.
template <class Visit>
void forEachPiece(const TrianglePiece& triangle, double longest, const Visit& visit) {
  int side = 0;
  std::array<double, 3> lengths{};
  for (int k = 0; k < 3; ++k) {
    lengths[k] = (triangle.col((k + 1) % 3) - triangle.col(k)).norm();
    if (lengths[k] > lengths[side]) side = k;
  }
  if (!(lengths[side] > longest)) return visit(triangle);
  const Eigen::Vector3d a = triangle.col(side), b = triangle.col((side + 1) % 3),
                        c = triangle.col((side + 2) % 3), middle = (a + b) / 2;
  TrianglePiece half;
  half << a, middle, c;
  forEachPiece(half, longest, visit);
  half << middle, b, c;
  forEachPiece(half, longest, visit);
}

/// The corners of a triangle of a mesh.
inline TrianglePiece cornersOf(const TriangleMesh& mesh, Eigen::Index t) {
  TrianglePiece corners;
  corners << mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2);
  return corners;
}

}  // namespace ambient
