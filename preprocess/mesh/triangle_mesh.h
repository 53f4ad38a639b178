#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <utility>
#include <vector>

namespace ambient {

/// Indexed triangle mesh. Triangles are counter-clockwise seen from the fluid: (b - a) x (c - a)
/// points into it.
struct TriangleMesh {
  Eigen::Matrix3Xd vertices;   ///< 3 x V [m]
  Eigen::Matrix3Xi triangles;  ///< 3 x T vertex indices

  Eigen::Index vertexCount() const { return vertices.cols(); }
  Eigen::Index triangleCount() const { return triangles.cols(); }
  Eigen::Vector3d corner(Eigen::Index triangle, int k) const {
    return vertices.col(triangles(k, triangle));
  }
  Eigen::Vector3d barycentre(Eigen::Index triangle) const {
    return (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3;
  }
  /// Normal of a triangle times twice its area [m^2].
  Eigen::Vector3d twiceArea(Eigen::Index triangle) const {
    const Eigen::Vector3d a = corner(triangle, 0);
    return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a);
  }
  /// Bounding box along the axes [m]. @pre there are vertices.
  Eigen::AlignedBox3d bounds() const {
    return {vertices.rowwise().minCoeff(), vertices.rowwise().maxCoeff()};
  }
  /// Sizes of the bounding box along the axes [m]. @pre there are vertices.
  Eigen::Vector3d extents() const {
    return vertices.rowwise().maxCoeff() - vertices.rowwise().minCoeff();
  }
};

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
  /// Numbers of the sets of all elements, by first appearance from 0 on.
  std::vector<int> numbers();

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

/// n + 1 points from -half_length to +half_length [m], denser towards both ends (cosine spacing),
/// symmetric bit for bit.
std::vector<double> cosineSpacing(double half_length, int n);

/// Two triangles per cell of a grid of (rows + 1) x (columns + 1) vertices, `vertex(row, column)`.
/// Diagonals run from the middle of the grid towards its corners (union jack), so that no corner is
/// cut off and the pattern is symmetric for even numbers. Counter-clockwise if columns run to the
/// right and rows upwards.
template <class VertexAt>
void appendGridTriangles(int rows, int columns, VertexAt vertex,
                         std::vector<Eigen::Vector3i>& triangles) {
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      const int a = vertex(i, j), b = vertex(i, j + 1);
      const int c = vertex(i + 1, j + 1), d = vertex(i + 1, j);
      if ((2 * i < rows) == (2 * j < columns)) {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
      } else {
        triangles.push_back({a, b, d});
        triangles.push_back({b, c, d});
      }
    }
  }
}

/// Makes a mesh of vertices and triangles.
TriangleMesh makeTriangleMesh(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<Eigen::Vector3i>& triangles);
TriangleMesh makeTriangleMesh(const Eigen::Ref<const Eigen::Matrix3Xd>& vertices,
                              const std::vector<Eigen::Vector3i>& triangles);

/// The columns of a matrix, as a list: vertices or triangles of a mesh.
template <class Matrix>
auto columnsOf(const Matrix& matrix) {
  std::vector<Eigen::Matrix<typename Matrix::Scalar, 3, 1>> columns;
  columns.reserve(static_cast<std::size_t>(matrix.cols()));
  for (const auto& column : matrix.colwise()) columns.emplace_back(column);
  return columns;
}

/// Makes a mesh of triangles and the vertices that they use, numbered in the order of first use.
/// @param vertices one per column
/// @param triangles numbers of columns, counter-clockwise seen from outside
TriangleMesh withUsedVertices(const Eigen::Matrix3Xd& vertices,
                              const std::vector<Eigen::Vector3i>& triangles);

/// Joins parts to one mesh, one after the other; welds nothing.
TriangleMesh joinMeshes(const std::vector<TriangleMesh>& parts);

/// Joins vertices closer than `tolerance` [m], also along chains, at the place of the first of
/// them, and removes triangles that lose a corner. Order is kept. Cost O(V log V + T)
/// plus the pairs that are close along one direction.
/// @pre coordinates are finite, tolerance >= 0; 0 joins equal vertices only.
TriangleMesh weldVertices(const TriangleMesh& mesh, double tolerance);

}  // namespace ambient
