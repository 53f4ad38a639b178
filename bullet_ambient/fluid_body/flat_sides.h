#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/surface_triangles.h"

namespace ambient {

/// A flat part of the surface with one convex outline.
struct FlatSide {
  std::vector<int> triangles;    ///< indices into the mesh, one or more
  std::vector<Vector3> corners;  ///< [m], counter-clockwise seen from the fluid, 3 or more
  Vector3 normal;                ///< unit, into the fluid
  bool has_sharp_rim = false;    ///< true: an edge to all that it borders on, kEdgeCosine
};

/// Finds the flat sides. A triangle belongs to at most one side; to none if the outline of its
/// plane is not convex or has holes. Cost O(F log F).
std::vector<FlatSide> findFlatSides(const SurfaceTriangles& mesh);

}  // namespace ambient
