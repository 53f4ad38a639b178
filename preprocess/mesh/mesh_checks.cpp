#include "preprocess/mesh/mesh_checks.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "preprocess/mesh/defect_message.h"
#include "preprocess/mesh/mesh_mending.h"
#include "preprocess/mesh/mesh_orientation.h"
#include "preprocess/mesh/mesh_shells.h"
#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/mesh_union.h"
#include "preprocess/mesh/topology_defects.h"

namespace ambient {
namespace {

CheckedMesh withoutUnusedVertices(const TriangleMesh& mesh, const std::string& name) {
  std::vector<int> new_index(mesh.vertexCount(), -1);
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i) new_index[mesh.triangles.data()[i]] = 0;
  int used = 0;
  for (int& index : new_index) {
    if (index == 0) index = used++;
  }
  CheckedMesh result{mesh, {}};
  if (used == mesh.vertexCount()) return result;
  result.mesh.vertices.resize(3, used);
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    if (new_index[v] >= 0) result.mesh.vertices.col(new_index[v]) = mesh.vertices.col(v);
  }
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i) {
    result.mesh.triangles.data()[i] = new_index[mesh.triangles.data()[i]];
  }
  result.warnings.push_back(name + ": " + std::to_string(mesh.vertexCount() - used) +
                            " vertices belong to no triangle and were left out");
  return result;
}

void takeStep(CheckedMesh& so_far, CheckedMesh step) {
  so_far.mesh = std::move(step.mesh);
  so_far.cavities = std::move(step.cavities);
  so_far.warnings.insert(so_far.warnings.end(), step.warnings.begin(), step.warnings.end());
}

CheckedMesh checkSheet(CheckedMesh mended, const std::string& name) {
  requireNone(findDoubleTriangles(mended.mesh), name);
  const MeshEdges edges = computeMeshEdges(mended.mesh);
  requireNone(findTopologyDefects(mended.mesh, edges, {true}), name);
  takeStep(mended, orientConsistently(mended.mesh, edges, name));
  return mended;
}

}  // namespace

CheckedMesh mendTriangles(const TriangleMesh& mesh, const std::string& name) {
  requireNone(findValueDefects(mesh), name);
  CheckedMesh result = withoutCopies(mesh, name);
  takeStep(result, withoutFlatTriangles(result.mesh, name));
  requireNone(findFlatTriangles(result.mesh), name);
  takeStep(result, withoutUnusedVertices(result.mesh, name));
  takeStep(result, withoutTJunctions(result.mesh, name));
  return result;
}

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

BodyVerdict judgeBody(const CheckedMesh& mended, const std::string& name) {
  BodyVerdict verdict{mended, findDoubleTriangles(mended.mesh)};
  const MeshEdges edges = computeMeshEdges(mended.mesh);
  for (const MeshDefect& defect : findTopologyDefects(mended.mesh, edges, {}))
    verdict.defects.push_back(defect);
  if (!verdict.defects.empty()) return verdict;
  takeStep(verdict.checked, orientConsistently(mended.mesh, edges, name));
  OrientedShells shells = orientShells(verdict.checked.mesh, edges, name);
  takeStep(verdict.checked, std::move(shells.checked));
  verdict.defects = std::move(shells.defects);
  return verdict;
}

CheckedMesh checkClosedMesh(const TriangleMesh& mesh, const std::string& name) {
  BodyVerdict verdict = judgeBody(mendTriangles(mesh, name), name);
  requireNone(verdict.defects, name);
  return std::move(verdict.checked);
}

CheckedMesh checkMesh(const TriangleMesh& mesh, const std::string& name,
                      const MeshCheckSettings& settings) {
  CheckedMesh mended = mendTriangles(mesh, name);
  if (settings.sheet) return checkSheet(std::move(mended), name);
  BodyVerdict verdict = judgeBody(mended, name);
  if (verdict.defects.empty()) return std::move(verdict.checked);
  std::optional<CheckedMesh> united = uniteClosedParts(mended.mesh, name);
  if (!united) requireNone(verdict.defects, name);
  takeStep(mended, std::move(*united));
  return mended;
}

}  // namespace ambient
