#include "preprocess/collision_shape/hull_mesh.h"

#include <LinearMath/btConvexHullComputer.h>

#include <string>

#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/polygon_triangles.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Numbers of the corners of one face, in btConvexHullComputer's numbers.
std::vector<int> cornersOf(const btConvexHullComputer& hull, int face) {
  std::vector<int> corners;
  const btConvexHullComputer::Edge* first = &hull.edges[hull.faces[face]];
  const btConvexHullComputer::Edge* edge = first;
  do {
    corners.push_back(edge->getSourceVertex());
    edge = edge->getNextEdgeOfFace();
  } while (edge != first);
  return corners;
}

/// Whether the points span a volume that is more than rounding. Flat hulls are asked too, so this
/// needs no volume to divide by, unlike computeMassProperties().
bool areInSpace(const TriangleMesh& mesh) {
  constexpr double kLeastThickness = 1e-6;
  if (mesh.triangleCount() < 4) return false;
  const Eigen::Vector3d origin = mesh.vertices.col(0);
  double volume = 0, area = 0;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    const Eigen::Vector3d a = mesh.vertices.col(corners[0]) - origin;
    const Eigen::Vector3d b = mesh.vertices.col(corners[1]) - origin;
    const Eigen::Vector3d c = mesh.vertices.col(corners[2]) - origin;
    volume += a.dot(b.cross(c)) / 6;
    area += (b - a).cross(c - a).norm() / 2;
  }
  return volume > kLeastThickness * mesh.extents().maxCoeff() * area;
}

}  // namespace

TriangleMesh makeHullMesh(const Points& points, const std::string& name) {
  constexpr std::size_t kLeastPoints = 4;
  if (points.size() < kLeastPoints) {
    raiseInputError(name, "a convex hull of ", points.size(), " points needs at least ",
                    kLeastPoints);
  }
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite()) raiseInputError(name, "a point of the hull is not finite");
  }
  btConvexHullComputer hull;
  hull.compute(points.front().data(), static_cast<int>(sizeof(Eigen::Vector3d)),
               static_cast<int>(points.size()), 0, 0);
  Points vertices;
  for (int i = 0; i < hull.vertices.size(); ++i) {
    vertices.push_back(points[static_cast<std::size_t>(hull.original_vertex_index[i])]);
  }
  std::vector<Eigen::Vector3i> triangles;
  for (int face = 0; face < hull.faces.size(); ++face) {
    const std::vector<int> corners = cornersOf(hull, face);
    if (corners.size() < 3) continue;
    Points polygon;
    for (const int corner : corners) polygon.push_back(vertices[static_cast<std::size_t>(corner)]);
    for (const Eigen::Vector3i& t : dividePolygon(polygon)) {
      triangles.emplace_back(corners[t[0]], corners[t[1]], corners[t[2]]);
    }
  }
  const TriangleMesh mesh = makeTriangleMesh(vertices, triangles);
  if (!areInSpace(mesh)) raiseInputError(name, "the points of the hull lie in a plane");
  return mesh;
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
