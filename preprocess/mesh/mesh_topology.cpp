#include "preprocess/mesh/mesh_topology.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace ambient {

MeshEdges computeMeshEdges(const TriangleMesh& mesh) {
  MeshEdges result;
  result.half_edges.reserve(3 * static_cast<std::size_t>(mesh.triangleCount()));
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles(k, t), b = mesh.triangles((k + 1) % 3, t);
      result.half_edges.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(result.half_edges.begin(), result.half_edges.end(),
            [](const HalfEdge& p, const HalfEdge& q) {
              return std::tie(p.low, p.high, p.triangle, p.side) <
                     std::tie(q.low, q.high, q.triangle, q.side);
            });
  const std::vector<HalfEdge>& sorted = result.half_edges;
  for (std::size_t first = 0; first < sorted.size();) {
    std::size_t last = first + 1;
    while (last < sorted.size() && sorted[last].low == sorted[first].low &&
           sorted[last].high == sorted[first].high) {
      ++last;
    }
    result.edges.push_back({first, last});
    first = last;
  }
  return result;
}

std::vector<EdgePair> edgePairs(const MeshEdges& edges) {
  std::vector<EdgePair> pairs;
  for (const EdgeGroup& edge : edges.edges) {
    if (edge.size() == 2)
      pairs.emplace_back(edges.half_edges[edge.first], edges.half_edges[edge.first + 1]);
  }
  return pairs;
}

std::vector<SortedTriangle> sortedByCorners(const TriangleMesh& mesh) {
  std::vector<SortedTriangle> sorted;
  for (int t = 0; t < static_cast<int>(mesh.triangleCount()); ++t) {
    SortedTriangle entry{{mesh.triangles(0, t), mesh.triangles(1, t), mesh.triangles(2, t)}, t};
    std::sort(entry.corners.begin(), entry.corners.end());
    sorted.push_back(entry);
  }
  std::sort(sorted.begin(), sorted.end(), [](const SortedTriangle& p, const SortedTriangle& q) {
    return std::tie(p.corners, p.triangle) < std::tie(q.corners, q.triangle);
  });
  return sorted;
}

bool isManifold(const MeshEdges& edges) {
  return std::all_of(edges.edges.begin(), edges.edges.end(),
                     [](const EdgeGroup& edge) { return edge.size() <= 2; });
}

bool isClosed(const MeshEdges& edges) {
  return std::all_of(edges.edges.begin(), edges.edges.end(), [&](const EdgeGroup& edge) {
    const HalfEdge* sides = edges.half_edges.data() + edge.first;
    return edge.size() == 2 && sides[0].forward != sides[1].forward;
  });
}

DisjointSets::DisjointSets(std::size_t count) : parent_(count) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

int DisjointSets::find(int element) {
  while (parent_[element] != element) {
    parent_[element] = parent_[parent_[element]];
    element = parent_[element];
  }
  return element;
}

void DisjointSets::join(int a, int b) {
  const int root_a = find(a), root_b = find(b);
  parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
}

void joinCorners(DisjointSets& corners, const TriangleMesh& mesh, const EdgePair& edge) {
  const auto cornerAt = [&](const HalfEdge& side, int vertex) {
    const bool at_start = mesh.triangles(side.side, side.triangle) == vertex;
    return 3 * side.triangle + (at_start ? side.side : (side.side + 1) % 3);
  };
  for (const int vertex : {edge.first.low, edge.first.high})
    corners.join(cornerAt(edge.first, vertex), cornerAt(edge.second, vertex));
}

MeshComponents computeMeshComponents(const TriangleMesh& mesh, const MeshEdges& edges) {
  const auto triangle_count = static_cast<std::size_t>(mesh.triangleCount());
  DisjointSets sets(triangle_count);
  for (const auto& [p, q] : edgePairs(edges)) sets.join(p.triangle, q.triangle);
  MeshComponents result;
  result.component_of.resize(triangle_count);
  std::vector<int> number_of_root(triangle_count, -1);
  for (std::size_t t = 0; t < triangle_count; ++t) {
    int& number = number_of_root[sets.find(static_cast<int>(t))];
    if (number < 0) number = result.count++;
    result.component_of[t] = number;
  }
  return result;
}

}  // namespace ambient
