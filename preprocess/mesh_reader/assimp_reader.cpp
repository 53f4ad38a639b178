#include "preprocess/mesh_reader/assimp_reader.h"

#include <assimp/config.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <stdexcept>

#include "preprocess/mesh_reader/geometry_text.h"
#include "preprocess/mesh_reader/turned_axes.h"

namespace ambient {
namespace {

Eigen::Affine3d transformOf(const aiNode& node) {
  const aiMatrix4x4& m = node.mTransformation;
  Eigen::Affine3d transform;
  transform.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4,
      m.d1, m.d2, m.d3, m.d4;
  return transform;
}

void addMesh(const aiMesh& mesh, const Eigen::Affine3d& transform, PolygonCollector& polygons) {
  polygons.beginMesh();
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    polygons.addVertex(transform * Eigen::Vector3d(p.x, p.y, p.z));
  }
  const bool mirrors = transform.linear().determinant() < 0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    std::vector<int> polygon(face.mIndices, face.mIndices + face.mNumIndices);
    if (mirrors) std::reverse(polygon.begin(), polygon.end());
    polygons.addPolygon(polygon);
  }
}

void addNode(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& parent,
             PolygonCollector& polygons) {
  const Eigen::Affine3d transform = parent * transformOf(node);
  for (unsigned i = 0; i < node.mNumMeshes; ++i)
    addMesh(*scene.mMeshes[node.mMeshes[i]], transform, polygons);
  for (unsigned i = 0; i < node.mNumChildren; ++i)
    addNode(scene, *node.mChildren[i], transform, polygons);
}

// Without post-processing: aiProcess_Triangulate of assimp 5.2 cuts across concave corners.
const aiScene* readScene(Assimp::Importer& importer, const std::string& file) {
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const std::optional<std::string> text = geometryText(file);
  if (!text) return importer.ReadFile(file, 0);
  return importer.ReadFileFromMemory(text->data(), text->size(), 0, extensionOf(file).c_str());
}

[[noreturn]] void refuse(const std::string& why) {
  const bool wants_memory = why.find("bad_alloc") != std::string::npos;
  throw std::runtime_error("cannot be read as a mesh: " +
                           (wants_memory ? "it announces more than there is memory for" : why));
}

}  // namespace

AssimpScene readWithAssimp(const std::string& file) {
  Assimp::Importer importer;
  const aiScene* scene = readScene(importer, file);
  if (scene == nullptr) refuse(importer.GetErrorString());
  AssimpScene result;
  if (scene->mRootNode == nullptr) return result;
  addNode(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), result.polygons);
  result.warning = turnedAxesWarning(extensionOf(file), transformOf(*scene->mRootNode).linear());
  return result;
}

}  // namespace ambient
