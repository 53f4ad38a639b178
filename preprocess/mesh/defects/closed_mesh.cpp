#include "preprocess/mesh/defects/closed_mesh.h"

#include <utility>

#include "preprocess/mesh/defects/mesh_orientation.h"
#include "preprocess/mesh/defects/mesh_shells.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/mend/mesh_mending.h"
#include "preprocess/mesh/mesh_defect.h"
#include "preprocess/mesh/mesh_topology.h"

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

}  // namespace

CheckedMesh mendTriangles(const TriangleMesh& mesh, const std::string& name) {
  requireNone(findValueDefects(mesh), name);
  CheckedMesh result = withoutCopies(mesh, name);
  result.takeStep(withoutFolds(result.mesh, name));
  result.takeStep(withoutFlatTriangles(result.mesh, name));
  requireNone(findFlatTriangles(result.mesh), name);
  result.takeStep(withoutUnusedVertices(result.mesh, name));
  result.takeStep(withoutTJunctions(result.mesh, name));
  return result;
}

BodyVerdict judgeBody(const CheckedMesh& mended, const std::string& name) {
  BodyVerdict verdict{mended, findDoubleTriangles(mended.mesh)};
  const MeshEdges edges = computeMeshEdges(mended.mesh);
  for (const MeshDefect& defect : findTopologyDefects(mended.mesh, edges, false))
    verdict.defects.push_back(defect);
  if (!verdict.defects.empty()) return verdict;
  verdict.checked.takeStep(orientConsistently(mended.mesh, edges, name));
  OrientedShells shells = orientShells(verdict.checked.mesh, edges, name);
  verdict.checked.takeStep(std::move(shells.checked));
  verdict.defects = std::move(shells.defects);
  return verdict;
}

CheckedMesh checkClosedMesh(const TriangleMesh& mesh, const std::string& name) {
  BodyVerdict verdict = judgeBody(mendTriangles(mesh, name), name);
  requireNone(verdict.defects, name);
  return std::move(verdict.checked);
}

}  // namespace ambient
