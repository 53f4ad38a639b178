#pragma once

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// The part of a closed mesh below the plane z = 0: open at the waterline, whose vertices have z =
/// 0 exactly, or closed if no triangle reaches it. A side in the plane counts as above it. Vertices
/// closer to each other than a thousandth of the mesh are joined. No triangles of a dry mesh.
TriangleMesh wetPartOf(const TriangleMesh& body);

/// A mesh below the plane z = 0 with its mirror image above, joined where z = 0. The triangles of
/// the mesh come first, those of the image follow in the same order, turned round.
struct MirroredMesh {
  TriangleMesh mesh;
  Eigen::VectorXi image;  ///< of each vertex of the wet part; itself on the waterline
};
MirroredMesh withImage(const TriangleMesh& wet);

}  // namespace ambient
