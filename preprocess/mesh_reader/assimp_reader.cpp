#include "preprocess/mesh_reader/assimp_reader.h"

#include <assimp/config.h>
#include <assimp/scene.h>

#include <Eigen/Core>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "preprocess/mesh_reader/geometry_text.h"

namespace ambient {
namespace {

/// "0.5 x - y" of a row; what is rounding only is left out.
std::string sumText(const Eigen::RowVector3d& row) {
  constexpr double kRounding = 1e-6;  // of single precision
  std::ostringstream text;
  text.precision(6);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(row[k]) <= kRounding) continue;
    const bool is_first = text.tellp() == 0;
    if (row[k] < 0) text << (is_first ? "-" : " - ");
    if (row[k] > 0 && !is_first) text << " + ";
    if (std::abs(std::abs(row[k]) - 1) > kRounding) text << std::abs(row[k]) << " ";
    text << "xyz"[k];
  }
  return text.str();
}

/// Returns one line that says how assimp has turned the axes of a file; empty if it has not. The
/// readers of some old formats turn z into y by the root node of the scene, whose linear part is
/// `root`.
std::string turnedAxesWarning(const std::string& extension, const Eigen::Matrix3d& root) {
  static const std::set<std::string> turned{"3ds",    "ase", "ask",     "dxf", "ifc",
                                            "ifczip", "iqm", "md2",     "md3", "mdc",
                                            "mdl",    "prj", "md5mesh", "stp", "step"};
  if (turned.count(extension) == 0) return {};
  const double size = root.norm() / std::sqrt(3.0);
  const Eigen::Matrix3d rotation = size > 0 ? Eigen::Matrix3d(root / size) : root;
  if (rotation.isIdentity(1e-6)) return {};
  return "files of this format are turned when they are read: (x, y, z) becomes (" +
         sumText(rotation.row(0)) + ", " + sumText(rotation.row(1)) + ", " +
         sumText(rotation.row(2)) + ")";
}

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
