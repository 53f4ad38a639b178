#include "preprocess/mesh/mesh_import.h"

#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <limits>
#include <sstream>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/polygon_triangles.h"
#include "preprocess/mesh/weld_vertices.h"

namespace ambient {
namespace {

std::string oneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

void requireReadableFile(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) raiseInputError(file.string(), "no such file");
  if (std::filesystem::is_directory(status)) {
    raiseInputError(file.string(), "is a directory, not a mesh file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    raiseInputError(file.string(), "is not a regular file");
  }
  if (std::filesystem::file_size(file, error) == 0) {
    raiseInputError(file.string(), "the file is empty");
  }
}

Eigen::Affine3d transformOf(const aiNode& node) {
  const aiMatrix4x4& m = node.mTransformation;
  Eigen::Affine3d transform;
  transform.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
      m.d1, m.d2, m.d3, m.d4;
  return transform;
}

/// The triangles of a scene in its own frame, still with one vertex list per mesh and node.
class SceneTriangles {
 public:
  SceneTriangles(const aiScene& scene, std::string name) : scene_(scene), name_(std::move(name)) {
    if (scene.mRootNode != nullptr) {
      appendNode(*scene.mRootNode, Eigen::Affine3d::Identity());
    }
  }

  TriangleMesh mesh() const {
    TriangleMesh mesh;
    mesh.vertices = Eigen::Map<const Eigen::Matrix3Xd>(
        coordinates_.data(), 3, static_cast<Eigen::Index>(coordinates_.size() / 3));
    mesh.triangles = Eigen::Map<const Eigen::Matrix3Xi>(
        indices_.data(), 3, static_cast<Eigen::Index>(indices_.size() / 3));
    return mesh;
  }

  std::size_t pointsAndLines() const { return points_and_lines_; }

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
        raiseInputError(name_, "a face refers to vertex ", index, ", but there are ",
                        vertex_count - first, " vertices");
      }
      index += first;
      corners.push_back(Eigen::Map<const Eigen::Vector3d>(&coordinates_[3 * index]));
    }
    for (const Eigen::Vector3i& t : dividePolygon(corners)) {
      indices_.insert(indices_.end(), {polygon[t[0]], polygon[t[1]], polygon[t[2]]});
    }
  }

  const aiScene& scene_;
  std::string name_;
  std::vector<double> coordinates_;
  std::vector<int> indices_;
  std::size_t points_and_lines_ = 0;
};

SceneTriangles readScene(Assimp::Importer& importer, const std::filesystem::path& file) {
  const aiScene* scene = nullptr;
  std::string reason;
  try {
    // Without post-processing: aiProcess_Triangulate of assimp 5.2 cuts across concave corners.
    scene = importer.ReadFile(file.string(), 0);
    reason = importer.GetErrorString();
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (scene == nullptr) {
    raiseInputError(file.string(), "cannot be read as a mesh: ", oneLine(reason));
  }
  return SceneTriangles(*scene, file.string());
}

// Single precision relative to the origin, as the file gives it, may be coarse relative to the
// body.
std::string resolutionWarning(const TriangleMesh& mesh, double diagonal) {
  constexpr double kCoarse = 1e-4;
  const double farthest = mesh.vertices.cwiseAbs().maxCoeff();
  const double resolution = std::numeric_limits<float>::epsilon() * farthest / diagonal;
  if (resolution < kCoarse) return {};
  std::ostringstream warning;
  warning.precision(3);
  warning << "lies " << farthest / diagonal << " times its size from the origin, where single "
          << "precision resolves only " << resolution << " of its size: move it to the origin";
  return warning.str();
}

void weld(ImportedMesh& imported, const std::string& name) {
  TriangleMesh& mesh = imported.mesh;
  const double diagonal =
      (mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff()).norm();
  const std::string warning = resolutionWarning(mesh, diagonal);
  if (!warning.empty()) imported.warnings.push_back(name + ": " + warning);
  const Eigen::Index before = mesh.triangleCount();
  mesh = weldVertices(mesh, kWeldTolerance * diagonal);
  if (mesh.triangleCount() == before) return;
  std::ostringstream text;
  text << name << ": " << before - mesh.triangleCount() << " of " << before
       << " triangles are shorter than " << kWeldTolerance << " of its size and were left out";
  imported.warnings.push_back(text.str());
}

}  // namespace

ImportedMesh importMesh(const std::filesystem::path& file, double scale) {
  const std::string name = file.string();
  if (!std::isfinite(scale) || scale <= 0) {
    raiseInputError(name, "scale = ", scale, " is not positive and finite");
  }
  requireReadableFile(file);
  Assimp::Importer importer;
  const SceneTriangles scene = readScene(importer, file);
  ImportedMesh imported{scene.mesh(), {}};
  if (imported.mesh.triangleCount() == 0) raiseInputError(name, "there are no triangles");
  if (scene.pointsAndLines() > 0) {
    imported.warnings.push_back(name + ": " + std::to_string(scene.pointsAndLines()) +
                                " points and lines were left out");
  }
  // What is not finite cannot be welded; checkMesh() says which vertex it is.
  if (imported.mesh.vertices.allFinite()) weld(imported, name);
  imported.mesh.vertices *= scale;
  if (imported.mesh.triangleCount() == 0)
    raiseInputError(name, "all triangles are points or lines");
  return imported;
}

}  // namespace ambient
