#include "preprocess/potential_flow/surface/surface_refinement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"

namespace ambient {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

class Cutter {
 public:
  Cutter(const DividedSurface& surface, const MeshEdges& edges, const std::vector<bool>& marks)
      : surface_(surface),
        mesh_(surface.mesh),
        middle_(surface.mesh.triangleCount(), {-1, -1, -1}),
        vertices_(columnsOf(surface.mesh.vertices)) {
    for (std::size_t e = 0; e < marks.size(); ++e) {
      if (!marks[e]) continue;
      const EdgeGroup& group = edges.edges[e];
      for (std::size_t k = group.first; k < group.last; ++k)
        middle_[edges.half_edges[k].triangle][edges.half_edges[k].side] =
            static_cast<int>(vertices_.size());
      const HalfEdge& side = edges.half_edges[group.first];
      vertices_.push_back((mesh_.vertices.col(side.low) + mesh_.vertices.col(side.high)) / 2);
    }
  }

  DividedSurface cut() {
    DividedSurface result;
    for (Index t = 0; t < mesh_.triangleCount(); ++t) {
      cutTriangle(t);
      result.face.resize(triangles_.size(), surface_.face[t]);
    }
    result.mesh = makeTriangleMesh(vertices_, triangles_);
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

  const DividedSurface& surface_;
  const TriangleMesh& mesh_;
  std::vector<std::array<int, 3>> middle_;  ///< per triangle and side: the vertex that cuts it
  std::vector<Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace

Vector3d normalOf(const TriangleMesh& mesh, Index t) { return mesh.twiceArea(t).normalized(); }

DividedSurface undivided(const TriangleMesh& mesh) {
  DividedSurface surface{mesh, std::vector<int>(mesh.triangleCount())};
  std::iota(surface.face.begin(), surface.face.end(), 0);
  return surface;
}

DividedSurface cutEdges(const DividedSurface& surface, const MeshEdges& edges,
                        const std::vector<bool>& marks) {
  return Cutter(surface, edges, marks).cut();
}

namespace {

// No simple ratio of lengths is the inverse golden ratio, so that rounding does not decide.
constexpr double kLongEdge = 0.61803398874989485;
constexpr int kEdgeLevels = 4;
constexpr int kUniformShare = 3;  // one part in so many of the triangles, before sharp edges

/// One refinement: which edges (by number in MeshEdges::edges) are cut in the middle.
using Marks = std::vector<bool>;

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

DividedSurface cutLongEdges(const DividedSurface& surface) {
  const MeshEdges edges = computeMeshEdges(surface.mesh);
  return cutEdges(surface, edges, markLongEdges(surface.mesh, edges));
}

bool any(const Marks& marks) { return std::find(marks.begin(), marks.end(), true) != marks.end(); }

/// Thinned across sharp edges up to so many times while at most `max_triangles` result; returns how
/// often.
int thinAcrossSharpEdges(bool sheet, int most_levels, int max_triangles, DividedSurface& surface) {
  for (int level = 0; level < most_levels; ++level) {
    const MeshEdges edges = computeMeshEdges(surface.mesh);
    const Marks marks = markAcrossSharpEdges(surface.mesh, edges, sheet);
    if (!any(marks)) return level;
    DividedSurface finer = cutEdges(surface, edges, marks);
    if (finer.mesh.triangleCount() > max_triangles) return level;
    surface = std::move(finer);
  }
  return most_levels;
}

/// The surface before about the last halving of all its edges; null: it was not halved.
const DividedSurface* beforeHalving(const std::vector<DividedSurface>& uniform) {
  const auto last = static_cast<double>(uniform.back().mesh.triangleCount());
  const DividedSurface* best = nullptr;
  double least = portable::log(1.6);  // of the ratio of triangles, from 4
  for (const DividedSurface& surface : uniform) {
    const auto count = static_cast<double>(surface.mesh.triangleCount());
    const double distance = std::abs(portable::log(last / (4 * count)));
    if (distance >= least) continue;
    least = distance;
    best = &surface;
  }
  return best;
}

}  // namespace

DividedSurface divideSurface(const TriangleMesh& mesh, int least_triangles) {
  AMBIENT_ASSERT(mesh.triangleCount() > 0 && isManifold(computeMeshEdges(mesh)));
  DividedSurface fine = undivided(mesh);
  while (fine.mesh.triangleCount() < least_triangles) fine = cutLongEdges(fine);
  return fine;
}

TriangleMesh divideTriangles(const TriangleMesh& mesh, int least_triangles) {
  return divideSurface(mesh, least_triangles).mesh;
}

TriangleMesh divideLongEdges(const TriangleMesh& mesh, double longest_edge) {
  AMBIENT_ASSERT(longest_edge > 0 && isManifold(computeMeshEdges(mesh)));
  DividedSurface fine = undivided(mesh);
  while (true) {
    const MeshEdges edges = computeMeshEdges(fine.mesh);
    const Marks marks = markLongerThan(longest_edge, fine.mesh, edges);
    if (!any(marks)) return fine.mesh;
    fine = cutEdges(fine, edges, marks);
  }
}

SurfaceLevels refineInLevels(const TriangleMesh& mesh, bool sheet, int max_triangles) {
  if (mesh.triangleCount() >= max_triangles) return {undivided(mesh), std::nullopt, std::nullopt};
  std::vector<DividedSurface> uniform = {undivided(mesh)};
  while (true) {
    DividedSurface finer = cutLongEdges(uniform.back());
    if (kUniformShare * finer.mesh.triangleCount() > max_triangles) break;
    uniform.push_back(std::move(finer));
  }
  SurfaceLevels levels{uniform.back(), std::nullopt, std::nullopt};
  const int thinned = thinAcrossSharpEdges(sheet, kEdgeLevels, max_triangles, levels.fine);
  if (thinned == 0) return levels;
  const DividedSurface* before = beforeHalving(uniform);
  DividedSurface other = before ? *before : uniform.back();
  thinAcrossSharpEdges(sheet, thinned - 1, max_triangles, other);
  (before ? levels.coarse : levels.less_thinned) = std::move(other.mesh);
  return levels;
}

TriangleMesh refineSurface(const TriangleMesh& mesh, bool sheet, int max_triangles) {
  return refineInLevels(mesh, sheet, max_triangles).fine.mesh;
}

}  // namespace ambient
