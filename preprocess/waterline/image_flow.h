#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Returns the part of a closed mesh below the plane z = 0: open at the waterline, whose vertices
/// have exactly z = 0, or closed if no triangle reaches the plane. A side in the plane counts as
/// above it. Vertices closer than a thousandth of the size are joined. A dry mesh gives no
/// triangles.
TriangleMesh wetPartOf(const TriangleMesh& body);

/// A mesh below the plane z = 0 with its mirror image above, joined where z = 0. The triangles of
/// the mesh come first, those of the image follow in the same order, turned round.
struct MirroredMesh {
  TriangleMesh mesh;
  Eigen::VectorXi image;  ///< number of the image of each vertex of the wet part; the vertex itself
                          ///< on the waterline
};
MirroredMesh withImage(const TriangleMesh& wet);

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
