#include "preprocess/mesh/check/mesh_checks.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "preprocess/mesh/defects/closed_mesh.h"
#include "preprocess/mesh/defects/mesh_orientation.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/mesh_defect.h"
#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/union/mesh_union.h"

namespace ambient {
namespace {

CheckedMesh checkSheet(CheckedMesh mended, const std::string& name) {
  requireNone(findDoubleTriangles(mended.mesh), name);
  const MeshEdges edges = computeMeshEdges(mended.mesh);
  requireNone(findTopologyDefects(mended.mesh, edges, true), name);
  mended.takeStep(orientConsistently(mended.mesh, edges, name));
  return mended;
}

}  // namespace

bool hasVerticesInside(const TriangleMesh& sheet) {
  const MeshEdges edges = computeMeshEdges(sheet);
  const MeshComponents components = computeMeshComponents(sheet, edges);
  std::vector<bool> is_on_boundary(sheet.vertexCount(), false);
  std::vector<bool> has_inside(components.count, false);
  for (const EdgeGroup& edge : edges.edges) {
    const HalfEdge& half_edge = edges.half_edges[edge.first];
    if (edge.size() == 1) is_on_boundary[half_edge.low] = is_on_boundary[half_edge.high] = true;
  }
  for (Eigen::Index t = 0; t < sheet.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k)
      if (!is_on_boundary[sheet.triangles(k, t)]) has_inside[components.component_of[t]] = true;
  }
  return std::find(has_inside.begin(), has_inside.end(), false) == has_inside.end();
}

CheckedMesh checkMesh(const TriangleMesh& mesh, const std::string& name,
                      const MeshCheckSettings& settings) {
  CheckedMesh mended = mendTriangles(mesh, name);
  if (settings.sheet) return checkSheet(std::move(mended), name);
  BodyVerdict verdict = judgeBody(mended, name);
  if (verdict.defects.empty()) return std::move(verdict.checked);
  std::optional<CheckedMesh> united = uniteClosedParts(mended.mesh, name);
  if (!united) requireNone(verdict.defects, name);
  mended.takeStep(std::move(*united));
  return mended;
}

}  // namespace ambient
