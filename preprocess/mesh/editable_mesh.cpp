#include "preprocess/mesh/editable_mesh.h"

#include <algorithm>
#include <iterator>

namespace ambient {

EditableMesh::EditableMesh(const TriangleMesh& mesh)
    : vertices(mesh.vertices), around(mesh.vertexCount()) {
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    triangles.emplace_back(mesh.triangles.col(t));
    for (const int v : triangles.back()) around[v].push_back(static_cast<int>(t));
  }
}

double EditableMesh::shapeOf(const Corners& t) const {
  double longest = 0;  // squared
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (point(t[(k + 1) % 3]) - point(t[k])).squaredNorm());
  return longest > 0 ? crossOf(t).norm() / longest : 0;
}

std::vector<int> EditableMesh::trianglesAt(int a, int b) const {
  const bool fewer_at_b = around[b].size() < around[a].size();
  std::vector<int> result;
  for (const int t : around[fewer_at_b ? b : a])
    if (holds(triangles[t], fewer_at_b ? a : b)) result.push_back(t);
  return result;
}

std::vector<int> EditableMesh::neighboursOf(int v) const {
  std::vector<int> result;
  for (const int t : around[v])
    for (const int corner : triangles[t])
      if (corner != v) result.push_back(corner);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::size_t EditableMesh::commonNeighbours(int a, int b) const {
  const std::vector<int> of_a = neighboursOf(a), of_b = neighboursOf(b);
  std::vector<int> common;
  std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                        std::back_inserter(common));
  return common.size();
}

int EditableMesh::contract(int v, int target) {
  int removed = 0;
  for (const int t : around[v]) {
    Corners& corners = triangles[t];
    if (holds(corners, target)) {
      for (const int corner : corners) {
        std::vector<int>& list = around[corner];
        if (corner != v) list.erase(std::find(list.begin(), list.end(), t));
      }
      corners.setConstant(-1);
      ++removed;
      continue;
    }
    std::replace(corners.data(), corners.data() + 3, v, target);
    around[target].push_back(t);
  }
  around[v].clear();
  return removed;
}

std::vector<EditableMesh::Corners> EditableMesh::trianglesLeft() const {
  std::vector<Corners> left;
  for (const Corners& t : triangles)
    if (t[0] >= 0) left.push_back(t);
  return left;
}

}  // namespace ambient
