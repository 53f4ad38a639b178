#include "preprocess/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

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

std::vector<int> DisjointSets::numbers() {
  std::vector<int> number(parent_.size(), -1), of_element(parent_.size());
  int count = 0;
  for (std::size_t i = 0; i < parent_.size(); ++i) {
    int& of_root = number[find(static_cast<int>(i))];
    if (of_root < 0) of_root = count++;
    of_element[i] = of_root;
  }
  return of_element;
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
  MeshComponents result{sets.numbers(), 0};
  for (const int number : result.component_of) result.count = std::max(result.count, number + 1);
  return result;
}

std::vector<double> cosineSpacing(double half_length, int n) {
  std::vector<double> points(n + 1, 0.0);
  for (int i = 0; 2 * i < n; ++i) {
    points[n - i] = half_length * portable::cos(kPi * i / n);
    points[i] = -points[n - i];
  }
  return points;
}

TriangleMesh makeTriangleMesh(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<Eigen::Vector3i>& triangles) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(vertices.size()));
  for (std::size_t i = 0; i < vertices.size(); ++i) columns.col(i) = vertices[i];
  return makeTriangleMesh(columns, triangles);
}

TriangleMesh makeTriangleMesh(const Eigen::Ref<const Eigen::Matrix3Xd>& vertices,
                              const std::vector<Eigen::Vector3i>& triangles) {
  TriangleMesh mesh;
  mesh.vertices = vertices;
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (std::size_t i = 0; i < triangles.size(); ++i) mesh.triangles.col(i) = triangles[i];
  return mesh;
}

TriangleMesh withUsedVertices(const Eigen::Matrix3Xd& vertices,
                              const std::vector<Eigen::Vector3i>& triangles) {
  std::vector<int> number(static_cast<std::size_t>(vertices.cols()), -1);
  std::vector<Eigen::Vector3d> used;
  std::vector<Eigen::Vector3i> renumbered = triangles;
  for (Eigen::Vector3i& triangle : renumbered) {
    for (int& v : triangle) {
      int& own = number[static_cast<std::size_t>(v)];
      if (own < 0) {
        own = static_cast<int>(used.size());
        used.emplace_back(vertices.col(v));
      }
      v = own;
    }
  }
  return makeTriangleMesh(used, renumbered);
}

TriangleMesh joinMeshes(const std::vector<TriangleMesh>& parts) {
  Eigen::Index vertices = 0, triangles = 0;
  for (const TriangleMesh& part : parts) {
    vertices += part.vertexCount();
    triangles += part.triangleCount();
  }
  TriangleMesh mesh;
  mesh.vertices.resize(3, vertices);
  mesh.triangles.resize(3, triangles);
  vertices = triangles = 0;
  for (const TriangleMesh& part : parts) {
    mesh.vertices.middleCols(vertices, part.vertexCount()) = part.vertices;
    mesh.triangles.middleCols(triangles, part.triangleCount()) =
        part.triangles.array() + static_cast<int>(vertices);
    vertices += part.vertexCount();
    triangles += part.triangleCount();
  }
  return mesh;
}

namespace {

/// Joins all vertices that are closer to each other than the tolerance. Sweeps along a direction in
/// which they differ; along a side of the mesh they would not.
void joinClose(const TriangleMesh& mesh, double tolerance, DisjointSets& sets) {
  const Eigen::Vector3d direction = Eigen::Vector3d(0.73, 0.55, 0.41).normalized();
  const Eigen::Vector3d middle = mesh.bounds().center();
  std::vector<std::pair<double, int>> along;
  for (int v = 0; v < static_cast<int>(mesh.vertexCount()); ++v)
    along.emplace_back(direction.dot(mesh.vertices.col(v) - middle), v);
  std::sort(along.begin(), along.end());
  const double reach = tolerance + std::ldexp(mesh.extents().norm(), -48);  // what rounding adds
  for (std::size_t i = 0; i < along.size(); ++i) {
    for (std::size_t j = i + 1; j < along.size() && along[j].first - along[i].first <= reach; ++j) {
      const int v = along[i].second, w = along[j].second;
      if ((mesh.vertices.col(v) - mesh.vertices.col(w)).norm() <= tolerance) sets.join(v, w);
    }
  }
}

}  // namespace

TriangleMesh weldVertices(const TriangleMesh& mesh, double tolerance) {
  AMBIENT_ASSERT(mesh.vertices.allFinite() && tolerance >= 0);
  if (mesh.vertexCount() == 0) return mesh;
  const int vertex_count = static_cast<int>(mesh.vertexCount());
  DisjointSets sets(vertex_count);
  joinClose(mesh, tolerance, sets);

  TriangleMesh result;
  result.vertices.resize(3, vertex_count);
  std::vector<int> new_index(vertex_count);
  int count = 0;
  for (int v = 0; v < vertex_count; ++v) {
    const int first = sets.find(v);
    if (first == v) {
      result.vertices.col(count) = mesh.vertices.col(v);
      new_index[v] = count++;
    } else {
      new_index[v] = new_index[first];
    }
  }
  result.vertices.conservativeResize(3, count);

  result.triangles.resize(3, mesh.triangleCount());
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const int a = new_index[mesh.triangles(0, t)], b = new_index[mesh.triangles(1, t)],
              c = new_index[mesh.triangles(2, t)];
    if (a != b && b != c && c != a) result.triangles.col(kept++) << a, b, c;
  }
  result.triangles.conservativeResize(3, kept);
  return result;
}

}  // namespace ambient
