#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Computes the added mass of the part of a closed body below the plane z = 0, on which the
/// potential is 0: the flow of fast motions. Per unit density, about the origin, rotation first;
/// symmetric; 0 of a dry body. The potential is odd in z: the wet part and its image are one body
/// in unbounded fluid, and n.(v + w x z) has the opposite sign at the image. The equations are
/// those of solvePotentialFlow(), docs/theory.md eq. (7) to (11), for odd jumps, on `panels` flat
/// panels of the wet part, or a few less. Error with 500 panels: 1 % (hemisphere).
/// @pre the mesh passed checkMesh() as a body
/// @throws std::runtime_error if the linear system cannot be solved
Matrix6 solveImageFlow(const TriangleMesh& body, int panels);

}  // namespace ambient
