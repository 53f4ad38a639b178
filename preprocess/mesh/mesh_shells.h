#pragma once

#include <string>

#include "preprocess/mesh/mesh_orientation.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {

/// Turns whole components round so that normals point out of the body, and takes those inside
/// another one out of the mesh, as cavities: they must point inwards, as they do in a consistent
/// mesh.
/// @pre closed, manifold, consistently oriented.
/// @throws std::runtime_error if a component encloses no volume, lies inside another one with the
/// wrong orientation, crosses or touches another one, or the surface encloses a part of the body
/// twice. The latter is tried at a sample of points, all triangles below about 3000; a component
/// that crosses itself elsewhere is warned of.
CheckedMesh orientOutward(const TriangleMesh& mesh, const MeshEdges& edges,
                          const std::string& name);

}  // namespace ambient
