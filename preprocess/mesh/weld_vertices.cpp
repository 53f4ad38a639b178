#include "preprocess/mesh/weld_vertices.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t k : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// Cubic cells some times as wide as the tolerance: what is close lies mostly in the same one.
class CellGrid {
 public:
  CellGrid(const TriangleMesh& mesh, double tolerance)
      : mesh_(mesh), corner_(mesh.vertices.rowwise().minCoeff()), tolerance_(tolerance) {
    const double extent = (mesh.vertices.rowwise().maxCoeff() - corner_).maxCoeff();
    // Cells of zero width, or more than 2^40 along an edge, could not be numbered.
    width_ = std::max(kTolerances * tolerance, std::ldexp(extent, -40));
    if (width_ == 0) width_ = 1;
  }

  /// Joins `vertex` to the earlier vertices close to it.
  void insert(int vertex, DisjointSets& sets) {
    const Eigen::Vector3d point = mesh_.vertices.col(vertex);
    const Cell low = cellOf(point.array() - tolerance_), high = cellOf(point.array() + tolerance_);
    for (std::int64_t i = low[0]; i <= high[0]; ++i) {
      for (std::int64_t j = low[1]; j <= high[1]; ++j) {
        for (std::int64_t k = low[2]; k <= high[2]; ++k) joinCell({i, j, k}, vertex, sets);
      }
    }
    vertices_in_[cellOf(point)].push_back(vertex);
  }

 private:
  static constexpr double kTolerances = 8;

  Cell cellOf(const Eigen::Vector3d& point) const {
    Cell cell{};
    for (int k = 0; k < 3; ++k)
      cell[k] = static_cast<std::int64_t>(std::floor((point[k] - corner_[k]) / width_));
    return cell;
  }

  void joinCell(const Cell& cell, int vertex, DisjointSets& sets) {
    const auto entry = vertices_in_.find(cell);
    if (entry == vertices_in_.end()) return;
    for (const int other : entry->second) {
      const double distance = (mesh_.vertices.col(vertex) - mesh_.vertices.col(other)).norm();
      if (distance <= tolerance_) sets.join(vertex, other);
    }
  }

  const TriangleMesh& mesh_;
  Eigen::Vector3d corner_;
  double tolerance_;
  double width_ = 1;
  std::unordered_map<Cell, std::vector<int>, CellHash> vertices_in_;
};

}  // namespace

TriangleMesh weldVertices(const TriangleMesh& mesh, double tolerance) {
  AMBIENT_ASSERT(mesh.vertices.allFinite() && tolerance >= 0);
  if (mesh.vertexCount() == 0) return mesh;
  const int vertex_count = static_cast<int>(mesh.vertexCount());
  DisjointSets sets(vertex_count);
  CellGrid grid(mesh, tolerance);
  for (int v = 0; v < vertex_count; ++v) grid.insert(v, sets);

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
