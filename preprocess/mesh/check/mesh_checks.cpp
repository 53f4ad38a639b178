#include "preprocess/mesh/check/mesh_checks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "preprocess/mesh/defects/closed_mesh.h"
#include "preprocess/mesh/defects/mesh_orientation.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/mend/mesh_mending.h"
#include "preprocess/mesh/mesh_defect.h"
#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/union/mesh_union.h"
#include "preprocess/mesh/usual_size.h"

namespace ambient {
namespace {

using Defects = std::vector<MeshDefect>;

void appendDefects(Defects& defects, const Defects& more) {
  defects.insert(defects.end(), more.begin(), more.end());
}

/// Runs `action` and returns the message with which it throws as a defect of that kind; none if it
/// does not throw.
template <class Action>
Defects refusalAsDefect(const std::string& kind, const std::string& name, const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    const bool begins_with_name = text.rfind(name + ": ", 0) == 0;
    return {{kind, begins_with_name ? text.substr(name.size() + 2) : text, {}}};
  }
  return {};
}

/// Finds where the surface of a mesh crosses itself or another part. For meshes that are not
/// closed; orientShells() finds the crossings of closed ones.
Defects findCrossings(const TriangleMesh& mesh, const MeshEdges& edges) {
  const SurfaceCrossings crossings =
      findSurfaceCrossings(mesh, computeMeshComponents(mesh, edges).component_of);
  Defects defects;
  const auto add = [&](const std::optional<TrianglePair>& pair, const char* kind,
                       const char* text) {
    if (!pair) return;
    defects.push_back({kind,
                       defectText(text, "triangle ", pair->first, " at ",
                                  pointText(mesh.corner(pair->first, 0)), " and triangle ",
                                  pair->second, " at ", pointText(mesh.corner(pair->second, 0))),
                       {pair->first, pair->second}});
  };
  add(crossings.between_parts, "parts overlap", "separate parts overlap or touch: ");
  add(crossings.within_part, "crosses itself", "the surface crosses itself: ");
  return defects;
}

/// A word of letters, digits and "_" for an OBJ file.
std::string wordOf(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ' ' || c == ','; }, '_');
  return text;
}

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

MeshDiagnosis diagnoseMesh(const TriangleMesh& mesh, const std::string& name,
                           const MeshCheckSettings& settings) {
  MeshDiagnosis diagnosis{{mesh, {}}, findValueDefects(mesh)};
  CheckedMesh& checked = diagnosis.checked;
  Defects& defects = diagnosis.defects;
  if (!defects.empty()) return diagnosis;
  checked.takeStep(withoutCopies(checked.mesh, name));
  checked.takeStep(withoutFolds(checked.mesh, name));
  checked.takeStep(withoutFlatTriangles(checked.mesh, name));
  appendDefects(defects, findFlatTriangles(checked.mesh));
  const bool has_normals = defects.empty();
  if (has_normals) checked.takeStep(withoutTJunctions(checked.mesh, name));
  const MeshEdges edges = computeMeshEdges(checked.mesh);
  if (has_normals && !settings.sheet) {
    appendDefects(defects, refusalAsDefect("one-sided", name, [&] {
                    BodyVerdict verdict = judgeBody(checked, name);
                    checked = std::move(verdict.checked);
                    defects = std::move(verdict.defects);
                  }));
  } else {
    appendDefects(defects, findDoubleTriangles(checked.mesh));
    appendDefects(defects, findTopologyDefects(checked.mesh, edges, settings.sheet));
  }
  if (settings.sheet && isManifold(edges)) {
    appendDefects(defects, refusalAsDefect("one-sided", name, [&] {
                    checked.takeStep(orientConsistently(checked.mesh, edges, name));
                  }));
  }
  if (has_normals && !isClosed(computeMeshEdges(checked.mesh)) && !settings.sheet)
    appendDefects(defects, findCrossings(checked.mesh, computeMeshEdges(checked.mesh)));
  if (defects.empty()) {
    appendDefects(defects, refusalAsDefect("size", name, [&] {
                    requireUsualSize(checked.mesh, settings.sheet, name);
                  }));
  }
  return diagnosis;
}

std::string defectsAsObj(const MeshDiagnosis& diagnosis) {
  const TriangleMesh& mesh = diagnosis.checked.mesh;
  std::ostringstream text;
  text.precision(9);
  int vertices = 0;
  for (const MeshDefect& defect : diagnosis.defects) {
    std::vector<int> triangles = defect.triangles;
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    text << "# " << defect.text << "\no " << wordOf(defect.kind) << "\n";
    for (const int t : triangles) {
      for (int k = 0; k < 3; ++k) text << "v " << mesh.corner(t, k).transpose() << "\n";
      text << "f " << vertices + 1 << " " << vertices + 2 << " " << vertices + 3 << "\n";
      vertices += 3;
    }
  }
  return text.str();
}

}  // namespace ambient
