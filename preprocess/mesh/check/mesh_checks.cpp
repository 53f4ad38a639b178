#include "preprocess/mesh/check/mesh_checks.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/mesh/union/mesh_union.h"

namespace ambient {
namespace {

/// Whether all values are in range and no triangle is flat.
bool hasNormals(const TriangleMesh& mesh) {
  return findValueDefects(mesh).empty() && findFlatTriangles(mesh).empty();
}

/// A word of letters, digits and "_" for an OBJ file.
std::string wordOf(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ' ' || c == ','; }, '_');
  return text;
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

CheckedMesh checkMesh(const TriangleMesh& mesh, const std::string& name, bool sheet) {
  CheckedMesh checked = checkSurface(mesh, name, sheet);
  if (sheet || checked.defects.empty() || !hasNormals(checked.mesh)) return checked;
  if (std::optional<CheckedMesh> united = uniteClosedParts(checked.mesh, name)) {
    checked.defects.clear();
    checked.takeStep(*std::move(united));
  }
  return checked;
}

std::vector<MeshDefect> findCrossings(const TriangleMesh& mesh) {
  std::vector<MeshDefect> defects;
  if (!hasNormals(mesh)) return defects;
  const MeshEdges edges = computeMeshEdges(mesh);
  if (isClosed(edges)) return defects;
  const SurfaceCrossings crossings =
      findSurfaceCrossings(mesh, computeMeshComponents(mesh, edges).component_of);
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

std::string defectsAsObj(const CheckedMesh& checked) {
  const TriangleMesh& mesh = checked.mesh;
  std::ostringstream text;
  text.precision(9);
  int vertices = 0;
  for (const MeshDefect& defect : checked.defects) {
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
