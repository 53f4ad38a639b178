#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Sets nose and camber of a wing whose sections are aerofoils: round at one end of the chord, thin
/// at the other one, docs/theory.md eq. (161a), or round at both, eq. (161e). Cost O(T).
/// @param mesh a closed body
/// @param triangles of it that are the wing
/// @param wing measured but for these two, which are 0
void setSection(const TriangleMesh& mesh, const std::vector<Eigen::Index>& triangles, Wing& wing);

}  // namespace ambient
