#include "preprocess/mesh/defects/topology_defects.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/checked_mesh.h"
#include "preprocess/mesh/mend/mesh_mending.h"

namespace ambient {

namespace {

struct Neighbour {
  int triangle = -1;
  bool same_sense = false;  // both run along the shared edge in the same direction: one is wrong
};

std::vector<std::vector<Neighbour>> neighboursOf(const TriangleMesh& mesh, const MeshEdges& edges) {
  std::vector<std::vector<Neighbour>> neighbours(mesh.triangleCount());
  for (const auto& [p, q] : edgePairs(edges)) {
    neighbours[p.triangle].push_back({q.triangle, p.forward == q.forward});
    neighbours[q.triangle].push_back({p.triangle, p.forward == q.forward});
  }
  return neighbours;
}

/// Finds the triangles of one component that must be reversed to agree with its first triangle.
class TurnSearch {
 public:
  TurnSearch(const TriangleMesh& mesh, const MeshEdges& edges)
      : mesh_(mesh), neighbours_(neighboursOf(mesh, edges)) {
    turned_.assign(neighbours_.size(), kUnknown);
  }

  /// The smaller half of the component of `start`, empty if it was visited before.
  std::vector<int> minorityOf(int start) {
    if (turned_[start] != kUnknown) return {};
    std::vector<int> kept, turned, open{start};
    turned_[start] = 0;
    while (!open.empty()) {
      const int t = open.back();
      open.pop_back();
      (turned_[t] == 1 ? turned : kept).push_back(t);
      for (const Neighbour& neighbour : neighbours_[t]) visit(t, neighbour, open);
    }
    return turned.size() <= kept.size() ? turned : kept;
  }

  /// The surface of a component that was visited is one-sided; empty: none is.
  const std::vector<MeshDefect>& defects() const { return defects_; }

 private:
  static constexpr int kUnknown = -1;

  void visit(int from, const Neighbour& neighbour, std::vector<int>& open) {
    const int wanted = turned_[from] ^ static_cast<int>(neighbour.same_sense);
    int& turned = turned_[neighbour.triangle];
    if (turned == kUnknown) {
      turned = wanted;
      open.push_back(neighbour.triangle);
    } else if (turned != wanted && defects_.empty()) {
      defects_.push_back(
          {"one-sided",
           defectText("the surface is one-sided, as a Moebius strip is, near triangle ", from,
                      " at ", pointText(mesh_.corner(from, 0))),
           {from, neighbour.triangle}});
    }
  }

  const TriangleMesh& mesh_;
  std::vector<std::vector<Neighbour>> neighbours_;
  std::vector<int> turned_;
  std::vector<MeshDefect> defects_;
};

}  // namespace

std::string pointText(const Eigen::Vector3d& point) {
  std::ostringstream text;
  text.precision(9);
  text << "(" << point.x() << ", " << point.y() << ", " << point.z() << ")";
  return text.str();
}

void turnRound(TriangleMesh& mesh, Eigen::Index triangle) {
  std::swap(mesh.triangles(1, triangle), mesh.triangles(2, triangle));
}

CheckedMesh orientConsistently(const TriangleMesh& mesh, const MeshEdges& edges,
                               const std::string& name) {
  AMBIENT_ASSERT(isManifold(edges));
  CheckedMesh result{mesh, {}};
  TurnSearch search(mesh, edges);
  std::size_t turned = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    for (const int wrong : search.minorityOf(t)) {
      turnRound(result.mesh, wrong);
      ++turned;
    }
  }
  if (!search.defects().empty()) return {mesh, {}, {}, search.defects()};
  if (turned > 0) {
    std::ostringstream warning;
    warning << name << ": " << turned << " of " << mesh.triangleCount()
            << " triangles were turned round to agree with their neighbours";
    result.warnings.push_back(warning.str());
  }
  return result;
}

namespace {

using Defects = std::vector<MeshDefect>;

std::string vertexText(const TriangleMesh& mesh, int vertex) {
  return std::to_string(vertex) + " " + pointText(mesh.vertices.col(vertex));
}

std::string edgeText(const TriangleMesh& mesh, const HalfEdge& edge) {
  return "vertex " + vertexText(mesh, edge.low) + " to vertex " + vertexText(mesh, edge.high);
}

std::string cornersText(const TriangleMesh& mesh, Eigen::Index t) {
  return vertexText(mesh, mesh.triangles(0, t)) + ", " + vertexText(mesh, mesh.triangles(1, t)) +
         ", " + vertexText(mesh, mesh.triangles(2, t));
}

Defects asList(const MeshDefect& defect) {
  return defect.text.empty() ? Defects() : Defects{defect};
}

MeshDefect openEdges(const TriangleMesh& mesh, const MeshEdges& edges) {
  MeshDefect defect{"not watertight", {}, {}};
  std::vector<const HalfEdge*> open;
  for (const EdgeGroup& edge : edges.edges)
    if (edge.size() == 1) open.push_back(&edges.half_edges[edge.first]);
  if (open.empty()) return defect;
  for (const HalfEdge* edge : open) defect.triangles.push_back(edge->triangle);
  defect.text = defectText("not watertight: ", open.size(), " boundary edges, for example from ",
                           edgeText(mesh, *open.front()), " of triangle ", open.front()->triangle);
  return defect;
}

MeshDefect nonManifoldEdges(const TriangleMesh& mesh, const MeshEdges& edges) {
  MeshDefect defect{"more than two triangles at an edge", {}, {}};
  std::vector<const EdgeGroup*> non_manifold;
  for (const EdgeGroup& edge : edges.edges)
    if (edge.size() > 2) non_manifold.push_back(&edge);
  if (non_manifold.empty()) return defect;
  for (const EdgeGroup* edge : non_manifold) {
    for (std::size_t i = edge->first; i < edge->last; ++i)
      defect.triangles.push_back(edges.half_edges[i].triangle);
  }
  defect.text = defectText("not manifold: ", non_manifold.size(),
                           " edges with more than 2 triangles, for example ",
                           edgeText(mesh, edges.half_edges[non_manifold.front()->first]), " with ",
                           non_manifold.front()->size());
  return defect;
}

// The corners of the triangles at a vertex must hang together through edges at that vertex.
MeshDefect touchingParts(const TriangleMesh& mesh, const MeshEdges& edges) {
  MeshDefect defect{"parts touch at a vertex", {}, {}};
  DisjointSets corners(3 * static_cast<std::size_t>(mesh.triangleCount()));
  for (const EdgePair& edge : edgePairs(edges)) joinCorners(corners, mesh, edge);
  std::vector<int> root_of_vertex(mesh.vertexCount(), -1);
  for (int corner = 0; corner < 3 * static_cast<int>(mesh.triangleCount()); ++corner) {
    const int vertex = mesh.triangles(corner % 3, corner / 3);
    int& root = root_of_vertex[vertex];
    if (root < 0) root = corners.find(corner);
    if (root == corners.find(corner)) continue;
    defect.triangles.push_back(root / 3);
    defect.triangles.push_back(corner / 3);
    if (!defect.text.empty()) continue;
    defect.text =
        defectText("not manifold: separate parts of the surface touch at vertex ",
                   vertexText(mesh, vertex), ", triangles ", root / 3, " and ", corner / 3);
  }
  return defect;
}

MeshDefect closedParts(const TriangleMesh& mesh, const MeshEdges& edges) {
  MeshDefect defect{"closed, not a sheet", {}, {}};
  const MeshComponents components = computeMeshComponents(mesh, edges);
  std::vector<bool> is_open(components.count, false);
  for (const EdgeGroup& edge : edges.edges) {
    if (edge.size() == 1)
      is_open[components.component_of[edges.half_edges[edge.first].triangle]] = true;
  }
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t)
    if (!is_open[components.component_of[t]]) defect.triangles.push_back(t);
  if (defect.triangles.empty()) return defect;
  const int first = defect.triangles.front();
  defect.text = defectText("the surface around triangle ", first, " at vertex ",
                           vertexText(mesh, mesh.triangles(0, first)),
                           " is closed: a sheet needs a boundary (a closed surface is a body)");
  return defect;
}

}  // namespace

Defects findValueDefects(const TriangleMesh& mesh) {
  if (mesh.triangleCount() == 0) return {{"no triangles", "there are no triangles", {}}};
  Defects defects;
  for (Eigen::Index v = 0; v < mesh.vertexCount() && defects.empty(); ++v) {
    for (int k = 0; k < 3 && defects.empty(); ++k) {
      const double x = mesh.vertices(k, v);
      if (std::isfinite(x)) continue;
      defects.push_back(
          {"not finite",
           defectText("vertex ", v, " has the coordinate ", "xyz"[k], " = ", x, ", must be finite"),
           {}});
    }
  }
  if (!defects.empty()) return defects;
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(k, t);
      if (v >= 0 && v < mesh.vertexCount()) continue;
      return {{"index out of range",
               defectText("triangle ", t, " refers to vertex ", v, ", but there are ",
                          mesh.vertexCount(), " vertices"),
               {}}};
    }
  }
  return {};
}

Defects findFlatTriangles(const TriangleMesh& mesh) {
  MeshDefect defect{"flat triangles", {}, {}};
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t)
    if (heightRatio(mesh, t) < kLeastHeight) defect.triangles.push_back(t);
  if (defect.triangles.empty()) return {};
  const int first = defect.triangles.front();
  defect.text = defectText("triangle ", first, " is degenerate: its height is ",
                           heightRatio(mesh, first), " of its longest edge, at least ",
                           kLeastHeight, " needed; corners ", cornersText(mesh, first));
  return {defect};
}

Defects findDoubleTriangles(const TriangleMesh& mesh) {
  MeshDefect defect{"doubled triangles", {}, {}};
  const std::vector<SortedTriangle> entries = sortedByCorners(mesh);
  for (std::size_t i = 1; i < entries.size(); ++i) {
    if (entries[i].corners != entries[i - 1].corners) continue;
    const int first = entries[i - 1].triangle, second = entries[i].triangle;
    defect.triangles.push_back(second);
    if (!defect.text.empty()) continue;
    const auto& corners = entries[i].corners;
    defect.text =
        defectText("triangles ", first, " and ", second, " have the same corners: vertices ",
                   vertexText(mesh, corners[0]), ", ", vertexText(mesh, corners[1]), ", ",
                   vertexText(mesh, corners[2]));
  }
  return asList(defect);
}

Defects findTopologyDefects(const TriangleMesh& mesh, const MeshEdges& edges, bool sheet) {
  Defects defects;
  const auto add = [&](const MeshDefect& defect) {
    if (!defect.text.empty()) defects.push_back(defect);
  };
  if (!sheet) add(openEdges(mesh, edges));
  add(nonManifoldEdges(mesh, edges));
  add(touchingParts(mesh, edges));
  if (sheet) add(closedParts(mesh, edges));
  return defects;
}

}  // namespace ambient
