#pragma once

#include <string>
#include <vector>

#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Text "(x, y, z)" for messages.
std::string pointText(const Eigen::Vector3d& point);

void turnRound(TriangleMesh& mesh, Eigen::Index triangle);

/// Turns triangles round until neighbours agree; the minority of each component gives way.
/// A one-sided surface, where that is impossible, is returned as it is, with a defect.
/// @pre every edge has one or two triangles.
CheckedMesh orientConsistently(const TriangleMesh& mesh, const MeshEdges& edges,
                               const std::string& name);

// Each function finds all triangles with a defect, one entry per kind of defect; the text has their
// number and one example. Cost O(T log T).

/// Finds missing triangles, coordinates that are not finite, indices out of range. Call it first:
/// the other functions need valid values.
std::vector<MeshDefect> findValueDefects(const TriangleMesh& mesh);

/// Finds triangles whose height is below kLeastHeight of the longest edge.
std::vector<MeshDefect> findFlatTriangles(const TriangleMesh& mesh);

/// Finds triangles on the same corners as another one.
std::vector<MeshDefect> findDoubleTriangles(const TriangleMesh& mesh);

/// Finds edges of more than two triangles, and vertices at which separate parts touch; on a body
/// also boundary edges, on a sheet closed parts.
std::vector<MeshDefect> findTopologyDefects(const TriangleMesh& mesh, const MeshEdges& edges,
                                            bool sheet);

/// Checks a mesh as checkMesh() does, but unites nothing: parts that touch are a defect. Defects
/// that only a closed surface can have are not looked for in others. With defects, the mesh is
/// mended as far as that goes, and not turned.
CheckedMesh checkSurface(const TriangleMesh& mesh, const std::string& name, bool sheet = false);

}  // namespace ambient
