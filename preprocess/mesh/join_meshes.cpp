#include "preprocess/mesh/join_meshes.h"

namespace ambient {

TriangleMesh joinMeshes(const std::vector<TriangleMesh>& parts) {
  Eigen::Index vertices = 0, triangles = 0;
  for (const TriangleMesh& part : parts) {
    vertices += part.vertexCount();
    triangles += part.triangleCount();
  }
  TriangleMesh mesh;
  mesh.vertices.resize(3, vertices);
  mesh.triangles.resize(3, triangles);
  vertices = triangles = 0;
  for (const TriangleMesh& part : parts) {
    mesh.vertices.middleCols(vertices, part.vertexCount()) = part.vertices;
    mesh.triangles.middleCols(triangles, part.triangleCount()) =
        part.triangles.array() + static_cast<int>(vertices);
    vertices += part.vertexCount();
    triangles += part.triangleCount();
  }
  return mesh;
}

}  // namespace ambient
