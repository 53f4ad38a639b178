#pragma once

#include <array>
#include <utility>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// One side of a triangle.
struct HalfEdge {
  int low = 0, high = 0;  ///< vertices of the edge, low < high
  int triangle = 0;
  int side = 0;          ///< from corner `side` to corner (side + 1) % 3
  bool forward = false;  ///< true: runs from low to high
};

/// Half edges of one edge: [first, last) of MeshEdges::half_edges.
struct EdgeGroup {
  std::size_t first = 0, last = 0;

  std::size_t size() const { return last - first; }
};

/// All half edges of a mesh, sorted by edge.
struct MeshEdges {
  std::vector<HalfEdge> half_edges;
  std::vector<EdgeGroup> edges;
};

/// Lists the edges of a mesh. Cost O(T log T).
MeshEdges computeMeshEdges(const TriangleMesh& mesh);

using EdgePair = std::pair<HalfEdge, HalfEdge>;

/// The half edges of all edges that have exactly two triangles, in the order of `edges`.
std::vector<EdgePair> edgePairs(const MeshEdges& edges);

/// Corners of a triangle in ascending order.
struct SortedTriangle {
  std::array<int, 3> corners{};
  int triangle = 0;
};

/// Lists all triangles sorted by their corners, so that triangles on the same corners are
/// neighbours. Cost O(T log T).
std::vector<SortedTriangle> sortedByCorners(const TriangleMesh& mesh);

/// True if every edge has one or two triangles.
bool isManifold(const MeshEdges& edges);
/// True if every edge has two triangles, which run along it in opposite directions.
bool isClosed(const MeshEdges& edges);

/// Disjoint sets over 0 .. n - 1.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count);

  int find(int element);
  void join(int a, int b);

 private:
  std::vector<int> parent_;
};

/// Joins the corners of two triangles that meet at an edge, at both of its ends. Corner k of
/// triangle t has the number 3 t + k.
void joinCorners(DisjointSets& corners, const TriangleMesh& mesh, const EdgePair& edge);

/// Triangles that hang together through edges of exactly two triangles.
struct MeshComponents {
  std::vector<int> component_of;  ///< per triangle, numbered by first appearance
  int count = 0;
};

MeshComponents computeMeshComponents(const TriangleMesh& mesh, const MeshEdges& edges);

}  // namespace ambient
