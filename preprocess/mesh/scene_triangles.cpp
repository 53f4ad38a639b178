#include "preprocess/mesh/scene_triangles.h"

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "preprocess/mesh/child_process.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/polygon_triangles.h"

namespace ambient {
namespace {

std::string oneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

Eigen::Affine3d transformOf(const aiNode& node) {
  const aiMatrix4x4& m = node.mTransformation;
  Eigen::Affine3d transform;
  transform.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
      m.d1, m.d2, m.d3, m.d4;
  return transform;
}

/// Walks through a scene and collects its triangles.
class TriangleCollector {
 public:
  explicit TriangleCollector(const aiScene& scene) : scene_(scene) {
    if (scene.mRootNode != nullptr) {
      appendNode(*scene.mRootNode, Eigen::Affine3d::Identity());
    }
  }

  const std::vector<double>& coordinates() const { return coordinates_; }
  const std::vector<int>& indices() const { return indices_; }
  std::uint64_t pointsAndLines() const { return points_and_lines_; }

 private:
  void appendNode(const aiNode& node, const Eigen::Affine3d& parent) {
    const Eigen::Affine3d transform = parent * transformOf(node);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      appendMesh(*scene_.mMeshes[node.mMeshes[i]], transform);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) appendNode(*node.mChildren[i], transform);
  }

  void appendMesh(const aiMesh& mesh, const Eigen::Affine3d& transform) {
    const int first = static_cast<int>(coordinates_.size() / 3);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      const Eigen::Vector3d moved = transform * Eigen::Vector3d(p.x, p.y, p.z);
      coordinates_.insert(coordinates_.end(), {moved.x(), moved.y(), moved.z()});
    }
    const bool mirrors = transform.linear().determinant() < 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices < 3) {
        ++points_and_lines_;
      } else {
        appendFace(mesh.mFaces[f], first, mirrors);
      }
    }
  }

  void appendFace(const aiFace& face, int first, bool mirrors) {
    std::vector<int> polygon(face.mIndices, face.mIndices + face.mNumIndices);
    if (mirrors) std::reverse(polygon.begin(), polygon.end());
    std::vector<Eigen::Vector3d> corners;
    const int vertex_count = static_cast<int>(coordinates_.size() / 3);
    for (int& index : polygon) {
      if (index < 0 || index >= vertex_count - first) {
        throw std::runtime_error("a face refers to vertex " + std::to_string(index) +
                                 ", but there are " + std::to_string(vertex_count - first) +
                                 " vertices");
      }
      index += first;
      corners.push_back(Eigen::Map<const Eigen::Vector3d>(&coordinates_[3 * index]));
    }
    for (const Eigen::Vector3i& t : dividePolygon(corners)) {
      indices_.insert(indices_.end(), {polygon[t[0]], polygon[t[1]], polygon[t[2]]});
    }
  }

  const aiScene& scene_;
  std::vector<double> coordinates_;
  std::vector<int> indices_;
  std::uint64_t points_and_lines_ = 0;
};

/// A number of elements, then the elements.
template <class Number>
void append(std::string& bytes, const std::vector<Number>& numbers) {
  const std::uint64_t count = numbers.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
}

template <class Number>
std::vector<Number> take(const std::string& bytes, std::size_t& place) {
  std::uint64_t count = 0;
  std::memcpy(&count, &bytes.at(place), sizeof count);
  place += sizeof count;
  std::vector<Number> numbers(count);
  if (count > 0) std::memcpy(numbers.data(), &bytes.at(place), count * sizeof(Number));
  place += count * sizeof(Number);
  return numbers;
}

std::string readAsBytes(const std::filesystem::path& file) {
  Assimp::Importer importer;
  // Without post-processing: aiProcess_Triangulate of assimp 5.2 cuts across concave corners.
  const aiScene* scene = importer.ReadFile(file.string(), 0);
  if (scene == nullptr) {
    throw std::runtime_error(std::string("cannot be read as a mesh: ") + importer.GetErrorString());
  }
  const TriangleCollector collector(*scene);
  std::string bytes;
  append(bytes, std::vector<std::uint64_t>{collector.pointsAndLines()});
  append(bytes, collector.coordinates());
  append(bytes, collector.indices());
  return bytes;
}

int mostSecondsFor(const std::filesystem::path& file) {
  constexpr double kLeast = 10, kPerByte = 2e-6, kMost = 1e6;
  std::error_code error;
  const auto bytes = static_cast<double>(std::filesystem::file_size(file, error));
  return static_cast<int>(std::min(kMost, kLeast + (error ? 0 : kPerByte * bytes)));
}

std::string trimmed(const std::string& line) {
  const char* const kSpace = " \t\r";
  const std::size_t first = line.find_first_not_of(kSpace);
  if (first == std::string::npos) return {};
  return line.substr(first, line.find_last_not_of(kSpace) + 1 - first);
}

bool beginsLikePly(std::istream& stream) {
  std::array<char, 3> magic{};
  stream.read(magic.data(), magic.size());
  std::transform(magic.begin(), magic.end(), magic.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return magic == std::array<char, 3>{'p', 'l', 'y'};
}

// In a torn header assimp 5.2 looks for the next line that it knows for ever.
void requirePlyHeader(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!beginsLikePly(stream)) return;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    const std::string text = trimmed(line);
    if (text == "end_header") return;
    const std::string word = text.substr(0, text.find_first_of(" \t"));
    const auto known = {"", "comment", "element", "format", "obj_info", "property"};
    if (std::find(known.begin(), known.end(), word) == known.end()) break;
  }
  raiseInputError(file.string(), "cannot be read as a mesh: the header of the PLY file is damaged");
}

}  // namespace

SceneTriangles readSceneTriangles(const std::filesystem::path& file) {
  requirePlyHeader(file);
  std::string bytes;
  try {
    bytes = runInChild([&] { return readAsBytes(file); }, mostSecondsFor(file));
  } catch (const ChildFailure& failure) {
    raiseInputError(file.string(), "cannot be read as a mesh: its reader ", failure.what());
  } catch (const std::runtime_error& error) {
    raiseInputError(file.string(), oneLine(error.what()));
  }
  std::size_t place = 0;
  SceneTriangles scene;
  scene.points_and_lines = take<std::uint64_t>(bytes, place).at(0);
  const auto coordinates = take<double>(bytes, place);
  const auto indices = take<int>(bytes, place);
  scene.mesh.vertices = Eigen::Map<const Eigen::Matrix3Xd>(
      coordinates.data(), 3, static_cast<Eigen::Index>(coordinates.size() / 3));
  scene.mesh.triangles = Eigen::Map<const Eigen::Matrix3Xi>(
      indices.data(), 3, static_cast<Eigen::Index>(indices.size() / 3));
  return scene;
}

}  // namespace ambient
