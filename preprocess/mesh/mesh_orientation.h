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
};

/// Turns triangles round until neighbours agree; the minority of each component gives way.
/// @pre every edge has one or two triangles.
/// @throws std::runtime_error if that is impossible (a one-sided surface).
CheckedMesh orientConsistently(const TriangleMesh& mesh, const MeshEdges& edges,
                               const std::string& name);

/// Turns whole components round so that normals point out of the body. Components inside another
/// one are cavities filled with fluid and must point inwards, as they do in a consistent mesh.
/// @pre closed, manifold, consistently oriented.
/// @throws std::runtime_error if a component encloses no volume, lies inside another one with the
/// wrong orientation, or the surface overlaps itself. The latter is tried at a sample of points,
/// all triangles below about 3000.
CheckedMesh orientOutward(const TriangleMesh& mesh, const MeshEdges& edges,
                          const std::string& name);

}  // namespace ambient
