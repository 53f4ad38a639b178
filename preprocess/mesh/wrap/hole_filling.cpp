#include "preprocess/mesh/wrap/hole_filling.h"

#include <vector>

#include "preprocess/mesh/polygon_triangles.h"
#include "preprocess/mesh/wrap/open_loops.h"

namespace ambient {
namespace {

using Eigen::Vector3i;

double areaOf(const TriangleMesh& mesh, const Vector3i& triangle) {
  const Eigen::Vector3d a = mesh.vertices.col(triangle[0]);
  return (mesh.vertices.col(triangle[1]) - a).cross(mesh.vertices.col(triangle[2]) - a).norm() / 2;
}

/// The triangles that fill a loop.
struct Cap {
  std::vector<Vector3i> triangles;
  double area = 0;
  int component = 0;  ///< of the mesh
};

Cap makeCap(const TriangleMesh& mesh, const OpenLoop& loop) {
  std::vector<Eigen::Vector3d> corners;
  for (const int vertex : loop.vertices) corners.push_back(mesh.vertices.col(vertex));
  Cap cap;
  for (const Vector3i& t : dividePolygon(corners)) {
    cap.triangles.push_back({loop.vertices[t[0]], loop.vertices[t[1]], loop.vertices[t[2]]});
    cap.area += areaOf(mesh, cap.triangles.back());
  }
  return cap;
}

std::vector<Cap> makeCaps(const TriangleMesh& mesh, const MeshEdges& edges,
                          const MeshComponents& components) {
  std::vector<Cap> caps;
  for (const OpenLoop& loop : findOpenLoops(mesh, edges)) {
    caps.push_back(makeCap(mesh, loop));
    caps.back().component = components.component_of[loop.triangle];
  }
  return caps;
}

/// By component.
std::vector<bool> findSheets(const TriangleMesh& mesh, const MeshComponents& components,
                             const std::vector<Cap>& caps) {
  constexpr double kSheet = 0.9;
  std::vector<double> areas(components.count, 0.0);
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    areas[components.component_of[t]] += areaOf(mesh, mesh.triangles.col(t));
  std::vector<bool> is_sheet(components.count, false);
  for (const Cap& cap : caps) {
    if (cap.area > kSheet * areas[cap.component]) is_sheet[cap.component] = true;
  }
  return is_sheet;
}

}  // namespace

FilledMesh withHolesFilled(const TriangleMesh& mesh) {
  const MeshEdges edges = computeMeshEdges(mesh);
  const MeshComponents components = computeMeshComponents(mesh, edges);
  const std::vector<Cap> caps = makeCaps(mesh, edges, components);
  const std::vector<bool> is_sheet = findSheets(mesh, components, caps);
  FilledMesh filled{mesh};
  std::vector<Vector3i> added;
  for (const Cap& cap : caps) {
    if (is_sheet[cap.component]) continue;
    added.insert(added.end(), cap.triangles.begin(), cap.triangles.end());
    filled.area += cap.area;
    ++filled.holes;
  }
  const Eigen::Index before = mesh.triangleCount();
  filled.mesh.triangles.conservativeResize(3, before + static_cast<Eigen::Index>(added.size()));
  for (std::size_t i = 0; i < added.size(); ++i)
    filled.mesh.triangles.col(before + static_cast<Eigen::Index>(i)) = added[i];
  return filled;
}

}  // namespace ambient
