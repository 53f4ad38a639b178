#pragma once

#include <array>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Height of the smooth surface that a mesh approximates above a flat triangle, the quadratic
/// 4 sum_k height[k] h_k h_{k+1} of the hat functions h. height[k] is at the middle of the edge
/// from corner k to corner k + 1 [m], positive into the fluid.
using FaceBulge = std::array<double, 3>;

/// Estimates the heights from the normals at the vertices (Max 1999). Empty if the surface is of
/// several pieces or has a sharp edge, 41 degrees or more between the normals: there a polyhedron
/// may stand for the body's volume in more ways than by its size. Zero where facets do not look
/// like samples of one smooth surface: at the tip of a cone, or next to facets of very different
/// size or turn. Cost O(T log T).
/// @pre the mesh is closed.
std::vector<FaceBulge> estimateBulges(const TriangleMesh& mesh);

}  // namespace ambient
