#include "preprocess/mesh/union/mesh_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/mesh_topology.h"
#include "preprocess/mesh/weld_vertices.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

/// The side of a body at an edge: its angle around the edge from low to high, and whether the body
/// lies at larger angles (a half edge from high to low) or at smaller ones.
struct WedgeSide {
  double angle = 0;
  HalfEdge edge;

  bool operator<(const WedgeSide& other) const {
    if (angle != other.angle) return angle < other.angle;
    return edge.forward && !other.edge.forward;  // one wedge ends before the next one begins
  }
};

std::vector<WedgeSide> sidesAround(const TriangleMesh& mesh, const MeshEdges& edges,
                                   const EdgeGroup& group) {
  const HalfEdge& first = edges.half_edges[group.first];
  const Vector3d low = mesh.vertices.col(first.low);
  const Vector3d along = (mesh.vertices.col(first.high) - low).stableNormalized();
  const Vector3d zero = along.unitOrthogonal(), quarter = along.cross(zero);
  // Triangles on each other differ by the rounding of their corners.
  constexpr double kSteps = 1e6;
  std::vector<WedgeSide> sides;
  for (std::size_t i = group.first; i < group.last; ++i) {
    const HalfEdge& edge = edges.half_edges[i];
    const Vector3d apex = mesh.corner(edge.triangle, (edge.side + 2) % 3) - low;
    const double angle = portable::atan2(apex.dot(quarter), apex.dot(zero));
    sides.push_back({std::round(angle * kSteps) / kSteps, edge});
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// Each side at which a wedge begins with the next one at which it ends, once around; none if they
/// are not as many.
std::vector<EdgePair> wedgesOf(const std::vector<WedgeSide>& sides) {
  std::vector<EdgePair> wedges;
  std::vector<HalfEdge> begun;
  std::vector<bool> is_used(sides.size(), false);
  for (std::size_t i = 0; i < 2 * sides.size(); ++i) {
    const std::size_t k = i % sides.size();
    if (is_used[k]) continue;
    if (!sides[k].edge.forward) {
      if (i < sides.size()) begun.push_back(sides[k].edge);
    } else if (!begun.empty()) {
      wedges.emplace_back(begun.back(), sides[k].edge);
      begun.pop_back();
      is_used[k] = true;
    }
  }
  if (2 * wedges.size() != sides.size()) wedges.clear();
  return wedges;
}

/// Every half edge with another one; none if that is not possible.
std::optional<std::vector<EdgePair>> pairEdges(const TriangleMesh& mesh) {
  const MeshEdges edges = computeMeshEdges(mesh);
  std::vector<EdgePair> pairs;
  for (const EdgeGroup& group : edges.edges) {
    if (group.size() == 2) {
      pairs.emplace_back(edges.half_edges[group.first], edges.half_edges[group.first + 1]);
      continue;
    }
    const std::vector<EdgePair> wedges = wedgesOf(sidesAround(mesh, edges, group));
    if (wedges.empty()) return std::nullopt;
    pairs.insert(pairs.end(), wedges.begin(), wedges.end());
  }
  return pairs;
}

/// Makes one mesh of all triangles t with the same `partOf(t)`. Corners of one set become one
/// vertex.
template <class PartOf>
std::vector<TriangleMesh> meshesOf(const TriangleMesh& mesh, const PartOf& partOf,
                                   DisjointSets& corners) {
  struct Part {
    std::vector<Vector3d> vertices;
    std::vector<Eigen::Vector3i> triangles;
    std::map<int, int> number;  // of a vertex, by the first corner of its set
  };
  std::vector<Part> made;
  std::map<int, std::size_t> part_of;
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    const auto entry = part_of.emplace(partOf(t), made.size()).first;
    if (entry->second == made.size()) made.emplace_back();
    Part& part = made[entry->second];
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      const auto [vertex, is_new] =
          part.number.emplace(corners.find(3 * t + k), static_cast<int>(part.vertices.size()));
      if (is_new) part.vertices.push_back(mesh.corner(t, k));
      triangle[k] = vertex->second;
    }
    part.triangles.push_back(triangle);
  }
  std::vector<TriangleMesh> meshes;
  for (const Part& part : made) meshes.push_back(makeTriangleMesh(part.vertices, part.triangles));
  return meshes;
}

}  // namespace

std::vector<TriangleMesh> componentsOf(const TriangleMesh& mesh) {
  DisjointSets corners(3 * static_cast<std::size_t>(mesh.triangleCount()));
  const MeshComponents parts = computeMeshComponents(mesh, computeMeshEdges(mesh));
  std::vector<TriangleMesh> meshes = meshesOf(
      mesh, [&](int t) { return parts.component_of[t]; }, corners);
  for (TriangleMesh& part : meshes) part = weldVertices(part, 0);
  return meshes;
}

std::vector<TriangleMesh> closedParts(const TriangleMesh& mesh) {
  const auto pairs = pairEdges(mesh);
  if (!pairs) return {};
  DisjointSets parts(static_cast<std::size_t>(mesh.triangleCount()));
  DisjointSets corners(3 * static_cast<std::size_t>(mesh.triangleCount()));
  for (const EdgePair& edge : *pairs) {
    parts.join(edge.first.triangle, edge.second.triangle);
    joinCorners(corners, mesh, edge);
  }
  return meshesOf(
      mesh, [&](int t) { return parts.find(t); }, corners);
}

}  // namespace ambient
