#pragma once

#include <Eigen/Core>
#include <string>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// The potentials of the six unit motions on a surface (V x 6, rotation first, as PotentialFlow has
/// them) as the text of an SVG picture: one view each, from above in the first octant. Blue is
/// below zero, red above, to the largest magnitude of the view; its range is written below. Of a
/// sheet it is the jump, seen on both sides. Cost O(T log T); some 400 bytes per triangle.
/// @pre as many rows as vertices; the surface has an extent.
std::string potentialPicture(const TriangleMesh& surface,
                             const Eigen::Matrix<double, Eigen::Dynamic, 6>& potential, bool sheet);

}  // namespace ambient
