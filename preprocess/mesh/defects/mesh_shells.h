#pragma once

#include <string>
#include <vector>

#include "preprocess/mesh/defects/mesh_orientation.h"
#include "preprocess/mesh/mesh_defect.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {

/// Result of orientShells(): the mesh with normals out of the body, if there are no defects.
struct OrientedShells {
  CheckedMesh checked;
  std::vector<MeshDefect> defects;
};

/// Turns whole components round so that normals point out of the body, and takes those inside
/// another one out of the mesh, as cavities: they must point inwards, as they do in a consistent
/// mesh. Defects: a component that encloses no volume, lies inside another one with the wrong
/// orientation, or crosses or touches another one; more than 1 % of the surface, tried at 256
/// places evenly over its area, that encloses the body otherwise than once. Warns of a component
/// that crosses itself elsewhere. Cost O(T log T) and 256 T solid angles.
/// @pre closed, manifold, consistently oriented.
OrientedShells orientShells(const TriangleMesh& mesh, const MeshEdges& edges,
                            const std::string& name);

}  // namespace ambient
