#pragma once

#include <cstdint>
#include <vector>

#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

/// Collects the polygons of a file, divided into triangles.
class PolygonCollector {
 public:
  /// Begins a list of vertices: the corners of polygons count from here on.
  void beginMesh() { first_ = vertexCount(); }
  void addVertex(const Eigen::Vector3d& vertex) {
    coordinates_.insert(coordinates_.end(), {vertex.x(), vertex.y(), vertex.z()});
  }
  /// Polygons of one or two corners are counted and left out.
  /// @throws std::runtime_error if it refers to a vertex that does not exist.
  void addPolygon(std::vector<int> polygon);

  const std::vector<double>& coordinates() const { return coordinates_; }
  const std::vector<int>& indices() const { return indices_; }
  std::int64_t pointsAndLines() const { return points_and_lines_; }

 private:
  int vertexCount() const { return static_cast<int>(coordinates_.size() / 3); }

  std::vector<double> coordinates_;
  std::vector<int> indices_;
  int first_ = 0;
  std::int64_t points_and_lines_ = 0;
};

}  // namespace ambient
