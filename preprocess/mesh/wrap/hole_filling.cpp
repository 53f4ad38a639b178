#include "preprocess/mesh/wrap/hole_filling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/defects/topology_defects.h"
#include "preprocess/mesh/geometry.h"

namespace ambient {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// A loop of edges that bound an odd number of triangles: the rim of a hole or of a sheet.
struct OpenLoop {
  std::vector<int>
      vertices;  ///< in order, opposite to the orientation of the triangles that the loop bounds
  int triangle = 0;  ///< one of these triangles
};

/// Walks along open edges until each was walked once. Every vertex has an even number of them, for
/// each triangle adds two or none to its corners: a walk ends where it began.
class OpenEdgeWalk {
 public:
  OpenEdgeWalk(const TriangleMesh& mesh, const MeshEdges& edges)
      : mesh_(mesh), edges_at_(mesh.vertexCount()), place_on_path_(mesh.vertexCount(), -1) {
    for (const EdgeGroup& group : edges.edges) {
      if (group.size() % 2 == 0) continue;
      const HalfEdge& edge = edges.half_edges[group.first];
      edges_at_[edge.low].push_back(static_cast<int>(open_.size()));
      if (edge.high != edge.low) edges_at_[edge.high].push_back(static_cast<int>(open_.size()));
      open_.push_back(edge);
    }
    was_walked_.assign(open_.size(), false);
  }

  std::vector<OpenLoop> findAll() {
    for (std::size_t e = 0; e < open_.size(); ++e) {
      if (!was_walked_[e]) walkFrom(static_cast<int>(e));
    }
    return std::move(loops_);
  }

 private:
  struct Step {
    int from = 0, edge = 0;
  };

  int otherEnd(int edge, int vertex) const {
    return open_[edge].low == vertex ? open_[edge].high : open_[edge].low;
  }

  void walkFrom(int edge) {
    int at = open_[edge].low;
    do {
      was_walked_[edge] = true;
      place_on_path_[at] = static_cast<int>(path_.size());
      path_.push_back({at, edge});
      at = otherEnd(edge, at);
      if (place_on_path_[at] >= 0) takeLoop(place_on_path_[at]);
      edge = path_.empty() ? -1 : nextEdge(at, path_.back().edge);
    } while (edge >= 0);
  }

  /// Takes the steps from `first` on off the path.
  void takeLoop(int first) {
    OpenLoop loop;
    int along = 0;
    for (auto step = path_.begin() + first; step != path_.end(); ++step) {
      const HalfEdge& edge = open_[step->edge];
      loop.vertices.push_back(step->from);
      along += edge.forward == (edge.low == step->from) ? 1 : -1;
      place_on_path_[step->from] = -1;
    }
    if (along > 0) std::reverse(loop.vertices.begin(), loop.vertices.end());
    loop.triangle = open_[path_[first].edge].triangle;
    path_.resize(first);
    // A triangle with two corners on one vertex has an edge that is no edge.
    if (loop.vertices.size() >= 3) loops_.push_back(std::move(loop));
  }

  /// The open edge at a vertex that is met first when an edge turns away from its triangle.
  int nextEdge(int vertex, int edge) const {
    int next = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const int candidate : edges_at_[vertex]) {
      if (was_walked_[candidate]) continue;
      const double angle = angleFrom(edge, candidate, vertex);
      if (angle < least) {
        next = candidate;
        least = angle;
      }
    }
    return next;
  }

  double angleFrom(int edge, int candidate, int vertex) const {
    const Vector3d centre = mesh_.vertices.col(vertex);
    const HalfEdge& side = open_[edge];
    const Vector3d across = mesh_.corner(side.triangle, (side.side + 2) % 3) - centre;
    const Vector3d from = mesh_.vertices.col(otherEnd(edge, vertex)) - centre;
    const Vector3d to = mesh_.vertices.col(otherEnd(candidate, vertex)) - centre;
    const Vector3d normal = across.cross(from).stableNormalized();
    const double angle = portable::atan2(from.cross(to).dot(normal), from.dot(to));
    return angle > 0 ? angle : angle + 2 * kPi;
  }

  const TriangleMesh& mesh_;
  std::vector<HalfEdge> open_;
  std::vector<std::vector<int>> edges_at_;  // by vertex
  std::vector<int> place_on_path_;          // by vertex
  std::vector<bool> was_walked_;
  std::vector<Step> path_;
  std::vector<OpenLoop> loops_;
};

/// Finds all loops of open edges; each passes a vertex once. Where several loops meet in a vertex,
/// each turns away from its triangle to the nearest open edge. Triangles may have either
/// orientation. Cost O(T log T).
/// @pre indices are in range, coordinates finite.
std::vector<OpenLoop> findOpenLoops(const TriangleMesh& mesh, const MeshEdges& edges) {
  return OpenEdgeWalk(mesh, edges).findAll();
}

double areaOf(const TriangleMesh& mesh, const Vector3i& triangle) {
  const Eigen::Vector3d a = mesh.vertices.col(triangle[0]);
  return (mesh.vertices.col(triangle[1]) - a).cross(mesh.vertices.col(triangle[2]) - a).norm() / 2;
}

/// The triangles that fill a loop.
struct Cap {
  std::vector<Vector3i> triangles;
  double area = 0;
  int component = 0;  ///< of the mesh
};

Cap makeCap(const TriangleMesh& mesh, const OpenLoop& loop) {
  std::vector<Eigen::Vector3d> corners;
  for (const int vertex : loop.vertices) corners.push_back(mesh.vertices.col(vertex));
  Cap cap;
  for (const Vector3i& t : dividePolygon(corners)) {
    cap.triangles.push_back({loop.vertices[t[0]], loop.vertices[t[1]], loop.vertices[t[2]]});
    cap.area += areaOf(mesh, cap.triangles.back());
  }
  return cap;
}

std::vector<Cap> makeCaps(const TriangleMesh& mesh, const MeshEdges& edges,
                          const MeshComponents& components) {
  std::vector<Cap> caps;
  for (const OpenLoop& loop : findOpenLoops(mesh, edges)) {
    caps.push_back(makeCap(mesh, loop));
    caps.back().component = components.component_of[loop.triangle];
  }
  return caps;
}

/// By component.
std::vector<double> areasOf(const TriangleMesh& mesh, const MeshComponents& components) {
  std::vector<double> areas(components.count, 0.0);
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    areas[components.component_of[t]] += areaOf(mesh, t);
  return areas;
}

}  // namespace

FilledMesh withHolesFilled(const TriangleMesh& mesh) {
  const MeshEdges edges = computeMeshEdges(mesh);
  const MeshComponents components = computeMeshComponents(mesh, edges);
  const std::vector<Cap> caps = makeCaps(mesh, edges, components);
  const std::vector<double> areas = areasOf(mesh, components);
  const double whole = std::accumulate(areas.begin(), areas.end(), 0.0);
  FilledMesh filled;
  std::vector<bool> is_sheet(components.count, false);
  for (const Cap& cap : caps) {
    if (cap.area > kSheet * areas[cap.component]) is_sheet[cap.component] = true;
    if (cap.area > kSheet * whole) filled.is_sheet = true;
  }
  std::vector<Vector3i> triangles = columnsOf(mesh.triangles);
  for (const Cap& cap : caps) {
    if (is_sheet[cap.component]) continue;
    triangles.insert(triangles.end(), cap.triangles.begin(), cap.triangles.end());
    filled.area += cap.area;
    ++filled.holes;
  }
  filled.mesh = makeTriangleMesh(mesh.vertices, triangles);
  return filled;
}

}  // namespace ambient
