#include "preprocess/mesh/weld_vertices.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/mesh_topology.h"

namespace ambient {
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
