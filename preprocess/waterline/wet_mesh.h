#pragma once

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

}  // namespace ambient
