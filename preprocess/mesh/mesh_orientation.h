#pragma once

#include <string>
#include <vector>

#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// A mesh that has passed a check, possibly with triangles turned round or vertices left out, and
/// what a user should know about that, one line each.
struct CheckedMesh {
  TriangleMesh mesh;
  std::vector<std::string> warnings;
  /// Closed parts inside the body, normals into the cavity; the fluid outside does not see them.
  TriangleMesh cavities = {};
};

/// "(x, y, z)" for messages.
std::string pointText(const Eigen::Vector3d& point);

void turnRound(TriangleMesh& mesh, Eigen::Index triangle);

/// Turns triangles round until neighbours agree; the minority of each component gives way.
/// @pre every edge has one or two triangles.
/// @throws std::runtime_error if that is impossible (a one-sided surface).
CheckedMesh orientConsistently(const TriangleMesh& mesh, const MeshEdges& edges,
                               const std::string& name);

}  // namespace ambient
