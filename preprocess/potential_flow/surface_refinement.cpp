#include "preprocess/potential_flow/surface_refinement.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "preprocess/mesh/mesh_topology.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// Limits that regular shapes never meet exactly, so that rounding does not decide: no regular
// polygon turns by acos(0.75), no simple ratio of lengths is the inverse golden ratio.
constexpr double kSharpCosine = 0.75;
constexpr double kLongEdge = 0.61803398874989485;
constexpr int kEdgeLevels = 4;
constexpr int kUniformShare = 3;  // one part in so many of the triangles, before sharp edges

/// One refinement: which edges (by number in MeshEdges::edges) are cut in the middle.
using Marks = std::vector<bool>;

Vector3d normalOf(const TriangleMesh& mesh, int t) {
  return (mesh.corner(t, 1) - mesh.corner(t, 0))
      .cross(mesh.corner(t, 2) - mesh.corner(t, 0))
      .normalized();
}

bool isSharp(const TriangleMesh& mesh, const MeshEdges& edges, const EdgeGroup& edge, bool sheet) {
  if (edge.size() != 2) return true;
  const HalfEdge& a = edges.half_edges[edge.first];
  const HalfEdge& b = edges.half_edges[edge.first + 1];
  const Vector3d normal = normalOf(mesh, a.triangle);
  if (normal.dot(normalOf(mesh, b.triangle)) > kSharpCosine) return false;
  const Vector3d apex = mesh.corner(b.triangle, (b.side + 2) % 3);
  return sheet || normal.dot(apex - mesh.corner(a.triangle, a.side)) < 0;
}

double edgeLength(const TriangleMesh& mesh, const HalfEdge& edge) {
  return (mesh.vertices.col(edge.low) - mesh.vertices.col(edge.high)).norm();
}

Marks markLongerThan(double limit, const TriangleMesh& mesh, const MeshEdges& edges) {
  Marks marks;
  for (const EdgeGroup& edge : edges.edges)
    marks.push_back(edgeLength(mesh, edges.half_edges[edge.first]) > limit);
  return marks;
}

Marks markLongEdges(const TriangleMesh& mesh, const MeshEdges& edges) {
  double longest = 0;
  for (const HalfEdge& edge : edges.half_edges) longest = std::max(longest, edgeLength(mesh, edge));
  return markLongerThan(kLongEdge * longest, mesh, edges);
}

/// Edges that end at a sharp edge but are not sharp themselves.
Marks markAcrossSharpEdges(const TriangleMesh& mesh, const MeshEdges& edges, bool sheet) {
  Marks sharp;
  std::vector<bool> sharp_vertex(mesh.vertexCount(), false);
  for (const EdgeGroup& edge : edges.edges) {
    sharp.push_back(isSharp(mesh, edges, edge, sheet));
    const HalfEdge& side = edges.half_edges[edge.first];
    if (sharp.back()) sharp_vertex[side.low] = sharp_vertex[side.high] = true;
  }
  Marks marks;
  for (std::size_t e = 0; e < edges.edges.size(); ++e) {
    const HalfEdge& side = edges.half_edges[edges.edges[e].first];
    marks.push_back(!sharp[e] && (sharp_vertex[side.low] || sharp_vertex[side.high]));
  }
  return marks;
}

/// Cuts triangles along marked edges; neighbours stay matched because they share the marks.
class Cutter {
 public:
  Cutter(const TriangleMesh& mesh, const MeshEdges& edges, const Marks& marks)
      : mesh_(mesh), middle_(mesh.triangleCount(), {-1, -1, -1}) {
    for (Index v = 0; v < mesh.vertexCount(); ++v) vertices_.push_back(mesh.vertices.col(v));
    for (std::size_t e = 0; e < marks.size(); ++e) {
      if (!marks[e]) continue;
      const EdgeGroup& group = edges.edges[e];
      for (std::size_t k = group.first; k < group.last; ++k)
        middle_[edges.half_edges[k].triangle][edges.half_edges[k].side] =
            static_cast<int>(vertices_.size());
      const HalfEdge& side = edges.half_edges[group.first];
      vertices_.push_back((mesh.vertices.col(side.low) + mesh.vertices.col(side.high)) / 2);
    }
  }

  TriangleMesh cut() {
    for (Index t = 0; t < mesh_.triangleCount(); ++t) cutTriangle(t);
    TriangleMesh result;
    result.vertices.resize(3, static_cast<Index>(vertices_.size()));
    result.triangles.resize(3, static_cast<Index>(triangles_.size()));
    for (std::size_t v = 0; v < vertices_.size(); ++v) result.vertices.col(v) = vertices_[v];
    for (std::size_t t = 0; t < triangles_.size(); ++t) result.triangles.col(t) = triangles_[t];
    return result;
  }

 private:
  void cutTriangle(Index t) {
    const std::array<int, 3>& middle = middle_[t];
    const auto cuts = std::count_if(middle.begin(), middle.end(), [](int m) { return m >= 0; });
    // Turn the triangle so that side 0 is the only cut one, or the only whole one.
    int turn = 0;
    while (cuts % 3 != 0 && (middle[turn] >= 0) != (cuts == 1)) ++turn;
    const int a = mesh_.triangles(turn, t), b = mesh_.triangles((turn + 1) % 3, t),
              c = mesh_.triangles((turn + 2) % 3, t);
    const int ab = middle[turn], bc = middle[(turn + 1) % 3], ca = middle[(turn + 2) % 3];
    switch (cuts) {
      case 0:
        add(a, b, c);
        break;
      case 1:
        add(a, ab, c);
        add(ab, b, c);
        break;
      case 2:
        add(ca, bc, c);
        addQuadrilateral(a, b, bc, ca);
        break;
      default:
        add(a, ab, ca);
        add(ab, b, bc);
        add(ca, bc, c);
        add(ab, bc, ca);
    }
  }

  void add(int a, int b, int c) { triangles_.emplace_back(a, b, c); }

  /// Along the shorter diagonal; among equal ones the choice follows the vertex numbers.
  void addQuadrilateral(int a, int b, int c, int d) {
    constexpr double kClearlyShorter = 0.99;
    const double ac = (vertices_[a] - vertices_[c]).norm();
    const double bd = (vertices_[b] - vertices_[d]).norm();
    const bool along_ac = ac < kClearlyShorter * bd || (!(bd < kClearlyShorter * ac) && a < b);
    if (along_ac) {
      add(a, b, c);
      add(a, c, d);
    } else {
      add(a, b, d);
      add(b, c, d);
    }
  }

  const TriangleMesh& mesh_;
  std::vector<std::array<int, 3>> middle_;  ///< per triangle and side: the vertex that cuts it
  std::vector<Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

TriangleMesh cutLongEdges(const TriangleMesh& mesh) {
  const MeshEdges edges = computeMeshEdges(mesh);
  return Cutter(mesh, edges, markLongEdges(mesh, edges)).cut();
}

bool any(const Marks& marks) { return std::find(marks.begin(), marks.end(), true) != marks.end(); }

}  // namespace

TriangleMesh divideTriangles(const TriangleMesh& mesh, int least_triangles) {
  TriangleMesh fine = mesh;
  while (fine.triangleCount() < least_triangles) fine = cutLongEdges(fine);
  return fine;
}

TriangleMesh divideLongEdges(const TriangleMesh& mesh, double longest_edge) {
  TriangleMesh fine = mesh;
  while (true) {
    const MeshEdges edges = computeMeshEdges(fine);
    const Marks marks = markLongerThan(longest_edge, fine, edges);
    if (!any(marks)) return fine;
    fine = Cutter(fine, edges, marks).cut();
  }
}

TriangleMesh refineTowardsFirst(const TriangleMesh& mesh, Index vertex_count, int max_triangles) {
  TriangleMesh fine = mesh;
  for (int level = 0; level < kEdgeLevels; ++level) {
    const MeshEdges edges = computeMeshEdges(fine);
    Marks marks;
    for (const EdgeGroup& edge : edges.edges) {
      const HalfEdge& side = edges.half_edges[edge.first];
      marks.push_back((side.low < vertex_count) != (side.high < vertex_count));
    }
    TriangleMesh finer = Cutter(fine, edges, marks).cut();
    if (finer.triangleCount() > max_triangles || !any(marks)) break;
    fine = std::move(finer);
  }
  return fine;
}

TriangleMesh refineSurface(const TriangleMesh& mesh, bool sheet, int max_triangles) {
  if (mesh.triangleCount() >= max_triangles) return mesh;
  TriangleMesh fine = mesh;
  while (true) {
    TriangleMesh finer = cutLongEdges(fine);
    if (kUniformShare * finer.triangleCount() > max_triangles) break;
    fine = std::move(finer);
  }
  for (int level = 0; level < kEdgeLevels; ++level) {
    const MeshEdges edges = computeMeshEdges(fine);
    const Marks marks = markAcrossSharpEdges(fine, edges, sheet);
    if (!any(marks)) break;
    TriangleMesh finer = Cutter(fine, edges, marks).cut();
    if (finer.triangleCount() > max_triangles) break;
    fine = std::move(finer);
  }
  return fine;
}

}  // namespace ambient
