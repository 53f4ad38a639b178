#pragma once

#include <string>

#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {

/// Text "(x, y, z)" for messages.
std::string pointText(const Eigen::Vector3d& point);

void turnRound(TriangleMesh& mesh, Eigen::Index triangle);

/// Turns triangles round until neighbours agree; the minority of each component gives way.
/// A one-sided surface, where that is impossible, is returned as it is, with a defect.
/// @pre every edge has one or two triangles.
CheckedMesh orientConsistently(const TriangleMesh& mesh, const MeshEdges& edges,
                               const std::string& name);

}  // namespace ambient
