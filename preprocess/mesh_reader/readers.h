#pragma once

#include <cstdint>
#include <optional>
#include <string>
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

/// Reads a file. @throws std::runtime_error if it cannot be read.
std::string readText(const std::string& file);

/// Extension of a file in small letters: "obj" for "Thing.OBJ".
std::string extensionOf(const std::string& file);

/// Returns the text of an OBJ or COLLADA file without parts that are not geometry and that make
/// assimp 5.2 refuse the file: texture coordinates and normals at the corners of faces, which it
/// miscounts if a file has normals only; effects, whose images may have no source. None for files
/// of other formats.
std::optional<std::string> geometryText(const std::string& file);

/// Polygons of a scene, placed by its nodes, once per node, and a warning line if the reader of the
/// format has turned the axes.
struct AssimpScene {
  PolygonCollector polygons;
  std::string warning;
};

/// Reads a file with assimp, the axes as they are in the file where that can be asked for.
/// @throws std::runtime_error with one sentence that does not name the file.
AssimpScene readWithAssimp(const std::string& file);

/// Reads the text of an OFF file, of any number of corners per face; normals, colours and texture
/// coordinates are passed over. assimp 5.2 believes what the header announces, leaves out faces of
/// ten and more corners and moves indices that are too large.
/// @throws std::runtime_error with one sentence, if it is damaged, binary or not of three
/// dimensions.
PolygonCollector readOff(const std::string& text);

}  // namespace ambient
