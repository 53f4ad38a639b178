#include "preprocess/potential_flow/surface/surface_refinement.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

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

TriangleMesh divideTriangles(const TriangleMesh& mesh, int least_triangles) {
  AMBIENT_ASSERT(mesh.triangleCount() > 0 && isManifold(computeMeshEdges(mesh)));
  DividedSurface fine = undivided(mesh);
  while (fine.mesh.triangleCount() < least_triangles) fine = cutLongEdges(fine);
  return fine.mesh;
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
