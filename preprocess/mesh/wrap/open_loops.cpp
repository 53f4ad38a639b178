#include "preprocess/mesh/wrap/open_loops.h"

#include <algorithm>
#include <limits>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

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

}  // namespace

std::vector<OpenLoop> findOpenLoops(const TriangleMesh& mesh, const MeshEdges& edges) {
  return OpenEdgeWalk(mesh, edges).findAll();
}

}  // namespace ambient
