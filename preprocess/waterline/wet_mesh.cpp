#include "preprocess/waterline/wet_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/weld_vertices.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::Vector3i;

/// Cuts triangles at z = 0. Points of the waterline are numbered before the mesh's own.
class WaterlineCut {
 public:
  explicit WaterlineCut(const TriangleMesh& body) : body_(body) {
    for (Index t = 0; t < body.triangleCount(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int a = body.triangles(k, t), b = body.triangles((k + 1) % 3, t);
        if (isWet(a) != isWet(b)) addCrossing(std::minmax(a, b));
      }
    for (Index t = 0; t < body.triangleCount(); ++t) addWetPart(body.triangles.col(t));
  }

  TriangleMesh mesh() const {
    std::vector<Vector3d> vertices = crossings_;
    for (Index v = 0; v < body_.vertexCount(); ++v) vertices.push_back(body_.vertices.col(v));
    return makeTriangleMesh(vertices, triangles_);
  }

 private:
  bool isWet(int vertex) const { return body_.vertices(2, vertex) < 0; }

  void addCrossing(const std::pair<int, int>& edge) {
    if (!numbers_.emplace(edge, static_cast<int>(crossings_.size())).second) return;
    const Vector3d a = body_.vertices.col(edge.first), b = body_.vertices.col(edge.second);
    Vector3d point = a + a.z() / (a.z() - b.z()) * (b - a);
    point.z() = 0;
    crossings_.push_back(point);
  }

  /// The polygon of the wet corners and the crossings, as a fan.
  void addWetPart(const Vector3i& corners) {
    std::vector<int> polygon;
    for (int k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      if (isWet(a)) polygon.push_back(static_cast<int>(crossings_.size()) + a);
      if (isWet(a) != isWet(b)) polygon.push_back(numbers_.at(std::minmax(a, b)));
    }
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
      triangles_.emplace_back(polygon[0], polygon[k], polygon[k + 1]);
  }

  const TriangleMesh& body_;
  std::map<std::pair<int, int>, int> numbers_;
  std::vector<Vector3d> crossings_;
  std::vector<Vector3i> triangles_;
};

/// Without triangles in the plane z = 0, which welding may leave, and vertices without a triangle.
TriangleMesh withoutLid(const TriangleMesh& mesh) {
  std::vector<Vector3i> triangles;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3i corners = mesh.triangles.col(t);
    if (!std::all_of(corners.begin(), corners.end(),
                     [&](int v) { return mesh.vertices(2, v) == 0; }))
      triangles.push_back(corners);
  }
  return withUsedVertices(mesh.vertices, triangles);
}

}  // namespace

TriangleMesh wetPartOf(const TriangleMesh& body) {
  constexpr double kClose = 1e-3, kInSurface = 1e-9;
  const double size = body.extents().maxCoeff();
  TriangleMesh placed = body;
  for (double& z : placed.vertices.row(2))
    if (std::abs(z) <= kInSurface * size) z = 0;
  return withoutLid(weldVertices(WaterlineCut(placed).mesh(), kClose * size));
}

MirroredMesh withImage(const TriangleMesh& wet) {
  MirroredMesh mirrored;
  AMBIENT_ASSERT(wet.vertexCount() == 0 || wet.vertices.row(2).maxCoeff() <= 0);
  mirrored.image.resize(wet.vertexCount());
  std::vector<Vector3d> vertices;
  for (Index v = 0; v < wet.vertexCount(); ++v) vertices.push_back(wet.vertices.col(v));
  for (Index v = 0; v < wet.vertexCount(); ++v) {
    const Vector3d point = wet.vertices.col(v);
    mirrored.image[v] = static_cast<int>(point.z() == 0 ? v : vertices.size());
    if (point.z() != 0) vertices.emplace_back(point.x(), point.y(), -point.z());
  }
  std::vector<Vector3i> triangles;
  for (Index t = 0; t < wet.triangleCount(); ++t) triangles.push_back(wet.triangles.col(t));
  for (Index t = 0; t < wet.triangleCount(); ++t) {
    const Vector3i corners = wet.triangles.col(t);
    triangles.emplace_back(mirrored.image[corners[0]], mirrored.image[corners[2]],
                           mirrored.image[corners[1]]);
  }
  mirrored.mesh = makeTriangleMesh(vertices, triangles);
  return mirrored;
}

}  // namespace ambient
