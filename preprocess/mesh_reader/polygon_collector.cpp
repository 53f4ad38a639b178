#include "preprocess/mesh_reader/polygon_collector.h"

#include <stdexcept>
#include <string>

#include "preprocess/mesh/polygon_triangles.h"

namespace ambient {

void PolygonCollector::addPolygon(std::vector<int> polygon) {
  if (polygon.size() < 3) {
    ++points_and_lines_;
    return;
  }
  std::vector<Eigen::Vector3d> corners;
  const int count = vertexCount() - first_;
  for (int& index : polygon) {
    if (index < 0 || index >= count) {
      throw std::runtime_error("a face refers to vertex " + std::to_string(index) +
                               ", but there are " + std::to_string(count) + " vertices");
    }
    index += first_;
    corners.emplace_back(
        Eigen::Map<const Eigen::Vector3d>(&coordinates_[3 * static_cast<std::size_t>(index)]));
  }
  for (const Eigen::Vector3i& t : dividePolygon(corners)) {
    indices_.insert(indices_.end(), {polygon[t[0]], polygon[t[1]], polygon[t[2]]});
  }
}

}  // namespace ambient
