// Reads a mesh file with assimp and writes its triangles to standard output:
//   ambient_mesh_reader FILE SECONDS
// A program of its own, for damaged files make some readers crash or run for ever (assimp 5.2: OFF
// files with wrong numbers of corners, PLY files with a torn header). It is started by
// readSceneTriangles(), which says what it writes.
#include <assimp/scene.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "preprocess/mesh/polygon_triangles.h"
#include "preprocess/mesh/scene_triangles.h"

namespace ambient {
namespace {

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
  std::int64_t pointsAndLines() const { return points_and_lines_; }

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
  std::int64_t points_and_lines_ = 0;
};

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
void requirePlyHeader(const std::string& file) {
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
  throw std::runtime_error("cannot be read as a mesh: the header of the PLY file is damaged");
}

template <class Number>
void write(const std::vector<Number>& numbers) {
  std::fwrite(numbers.data(), sizeof(Number), numbers.size(), stdout);
}

void writeTriangles(const TriangleCollector& triangles) {
  write<std::int64_t>({triangles.pointsAndLines(),
                       static_cast<std::int64_t>(triangles.coordinates().size() / 3),
                       static_cast<std::int64_t>(triangles.indices().size() / 3)});
  write(triangles.coordinates());
  write(triangles.indices());
}

// A crash shall end the program by its signal, without anybody's handler, report or core file.
void limitProcess(const char* most_seconds) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU})
    ::signal(signal, SIG_DFL);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const auto seconds = static_cast<rlim_t>(std::strtoul(most_seconds, nullptr, 10));
  const rlimit processor_time{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &processor_time);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg): the system's own interface
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
}

int readFile(const std::string& file) {
  try {
    requirePlyHeader(file);
    Assimp::Importer importer;
    // Without post-processing: aiProcess_Triangulate of assimp 5.2 cuts across concave corners.
    const aiScene* scene = importer.ReadFile(file, 0);
    if (scene == nullptr)
      throw std::runtime_error(std::string("cannot be read as a mesh: ") +
                               importer.GetErrorString());
    writeTriangles(TriangleCollector(*scene));
    return 0;
  } catch (const std::exception& error) {
    std::fputs(error.what(), stdout);
    return kRefusedByReader;
  }
}

}  // namespace
}  // namespace ambient

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: ambient_mesh_reader FILE SECONDS\n", stderr);
    return 2;
  }
  ambient::limitProcess(argv[2]);
  const int result = ambient::readFile(argv[1]);
  // Without the exit handlers of libraries whose memory may be damaged.
  std::_Exit(std::fflush(stdout) == 0 ? result : 1);
}
