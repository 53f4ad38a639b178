#include "preprocess/mesh/mesh_checks.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mesh_mending.h"
#include "preprocess/mesh/mesh_orientation.h"
#include "preprocess/mesh/mesh_shells.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {
namespace {

std::string vertexText(const TriangleMesh& mesh, int vertex) {
  std::ostringstream text;
  text.precision(9);
  text << vertex << " (" << mesh.vertices(0, vertex) << ", " << mesh.vertices(1, vertex) << ", "
       << mesh.vertices(2, vertex) << ")";
  return text.str();
}

std::string edgeText(const TriangleMesh& mesh, const HalfEdge& edge) {
  return "vertex " + vertexText(mesh, edge.low) + " to vertex " + vertexText(mesh, edge.high);
}

void requireFiniteVertices(const TriangleMesh& mesh, const std::string& name) {
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    for (int k = 0; k < 3; ++k) {
      const double x = mesh.vertices(k, v);
      if (std::isfinite(x)) continue;
      raiseInputError(name, "vertex ", v, " has the coordinate ", "xyz"[k], " = ", x,
                      ", must be finite");
    }
  }
}

void requireValidIndices(const TriangleMesh& mesh, const std::string& name) {
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(k, t);
      if (v >= 0 && v < mesh.vertexCount()) continue;
      raiseInputError(name, "triangle ", t, " refers to vertex ", v, ", but there are ",
                      mesh.vertexCount(), " vertices");
    }
  }
}

void requireProperTriangles(const TriangleMesh& mesh, const std::string& name) {
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const double ratio = heightRatio(mesh, t);
    if (ratio >= kLeastHeight) continue;
    raiseInputError(name, "triangle ", t, " is degenerate: its height is ", ratio,
                    " of its longest edge, at least ", kLeastHeight, " needed; corners ",
                    vertexText(mesh, mesh.triangles(0, t)), ", ",
                    vertexText(mesh, mesh.triangles(1, t)), ", ",
                    vertexText(mesh, mesh.triangles(2, t)));
  }
}

void requireDistinctTriangles(const TriangleMesh& mesh, const std::string& name) {
  const std::vector<SortedTriangle> entries = sortedByCorners(mesh);
  for (std::size_t i = 1; i < entries.size(); ++i) {
    if (entries[i].corners != entries[i - 1].corners) continue;
    raiseInputError(name, "triangles ", entries[i - 1].triangle, " and ", entries[i].triangle,
                    " have the same corners: vertices ", vertexText(mesh, entries[i].corners[0]),
                    ", ", vertexText(mesh, entries[i].corners[1]), ", ",
                    vertexText(mesh, entries[i].corners[2]));
  }
}

void requireClosed(const TriangleMesh& mesh, const MeshEdges& edges, const std::string& name) {
  std::size_t boundary = 0;
  const HalfEdge* example = nullptr;
  for (const EdgeGroup& edge : edges.edges) {
    if (edge.size() != 1) continue;
    if (boundary++ == 0) example = &edges.half_edges[edge.first];
  }
  if (boundary == 0) return;
  raiseInputError(name, "not watertight: ", boundary, " boundary edges, for example from ",
                  edgeText(mesh, *example), " of triangle ", example->triangle);
}

void requireManifoldEdges(const TriangleMesh& mesh, const MeshEdges& edges,
                          const std::string& name) {
  std::size_t count = 0;
  const EdgeGroup* example = nullptr;
  for (const EdgeGroup& edge : edges.edges) {
    if (edge.size() <= 2) continue;
    if (count++ == 0) example = &edge;
  }
  if (count == 0) return;
  raiseInputError(name, "not manifold: ", count, " edges with more than 2 triangles, for example ",
                  edgeText(mesh, edges.half_edges[example->first]), " with ", example->size());
}

// The corners of the triangles at a vertex must hang together through edges at that vertex.
void requireManifoldVertices(const TriangleMesh& mesh, const MeshEdges& edges,
                             const std::string& name) {
  DisjointSets corners(3 * static_cast<std::size_t>(mesh.triangleCount()));
  const auto cornerAt = [&](const HalfEdge& edge, int vertex) {
    const bool at_start = mesh.triangles(edge.side, edge.triangle) == vertex;
    return 3 * edge.triangle + (at_start ? edge.side : (edge.side + 1) % 3);
  };
  for (const EdgeGroup& edge : edges.edges) {
    if (edge.size() != 2) continue;
    const HalfEdge& p = edges.half_edges[edge.first];
    const HalfEdge& q = edges.half_edges[edge.first + 1];
    for (const int vertex : {p.low, p.high}) corners.join(cornerAt(p, vertex), cornerAt(q, vertex));
  }
  std::vector<int> root_of_vertex(mesh.vertexCount(), -1);
  for (int corner = 0; corner < 3 * static_cast<int>(mesh.triangleCount()); ++corner) {
    const int vertex = mesh.triangles(corner % 3, corner / 3);
    int& root = root_of_vertex[vertex];
    if (root < 0) root = corners.find(corner);
    if (root == corners.find(corner)) continue;
    raiseInputError(name, "not manifold: separate parts of the surface touch at vertex ",
                    vertexText(mesh, vertex), ", triangles ", root / 3, " and ", corner / 3);
  }
}

void requireSheet(const TriangleMesh& mesh, const MeshEdges& edges, const std::string& name) {
  const MeshComponents components = computeMeshComponents(mesh, edges);
  std::vector<bool> is_open(components.count, false);
  for (const EdgeGroup& edge : edges.edges) {
    if (edge.size() == 1)
      is_open[components.component_of[edges.half_edges[edge.first].triangle]] = true;
  }
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    if (is_open[components.component_of[t]]) continue;
    raiseInputError(name, "the surface around triangle ", t, " at vertex ",
                    vertexText(mesh, mesh.triangles(0, t)),
                    " is closed: a sheet needs a boundary (a closed surface is a body)");
  }
}

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
  if (mesh.triangleCount() == 0) raiseInputError(name, "there are no triangles");
  requireFiniteVertices(mesh, name);
  requireValidIndices(mesh, name);
  CheckedMesh result = withoutCopies(mesh, name);
  takeStep(result, withoutFlatTriangles(result.mesh, name));
  requireProperTriangles(result.mesh, name);
  requireDistinctTriangles(result.mesh, name);

  takeStep(result, withoutUnusedVertices(result.mesh, name));
  const MeshEdges edges = computeMeshEdges(result.mesh);
  if (!settings.sheet) requireClosed(result.mesh, edges, name);
  requireManifoldEdges(result.mesh, edges, name);
  requireManifoldVertices(result.mesh, edges, name);
  if (settings.sheet) requireSheet(result.mesh, edges, name);
  takeStep(result, orientConsistently(result.mesh, edges, name));
  if (!settings.sheet) takeStep(result, orientOutward(result.mesh, edges, name));
  return result;
}

}  // namespace ambient
