#pragma once

#include <string>

#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {

/// Text "(x, y, z)" for messages.
std::string pointText(const Eigen::Vector3d& point);

void turnRound(TriangleMesh& mesh, Eigen::Index triangle);

/// Turns triangles round until neighbours agree; the minority of each component gives way.
/// @pre every edge has one or two triangles.
/// @throws std::runtime_error if that is impossible (a one-sided surface).
CheckedMesh orientConsistently(const TriangleMesh& mesh, const MeshEdges& edges,
                               const std::string& name);

}  // namespace ambient
