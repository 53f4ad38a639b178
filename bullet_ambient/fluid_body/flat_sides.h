#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/surface_triangles.h"

namespace ambient {

/// A flat part of the surface with one convex outline.
struct FlatSide {
  std::vector<int> triangles;    ///< one or more
  std::vector<Vector3> corners;  ///< counter-clockwise from the fluid, 3 or more
  Vector3 normal;
};

/// Every triangle is in one side at most: in none, where its plane has another outline. Cost O(F
/// log F).
std::vector<FlatSide> findFlatSides(const SurfaceTriangles& mesh);

}  // namespace ambient
