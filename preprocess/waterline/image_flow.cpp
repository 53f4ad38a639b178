#include "preprocess/waterline/image_flow.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/matrices.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/near_moments.h"
#include "preprocess/potential_flow/surface/panel_surface.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

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

namespace {

using Eigen::Index;
using MatrixX6 = Eigen::Matrix<double, Eigen::Dynamic, 6>;
constexpr int kThreads = 1;

bool isOnWaterline(const MirroredMesh& mirrored, Index v) { return mirrored.image[v] == v; }

/// One for every vertex below the plane; none on the waterline, where odd jumps are 0.
Unknowns numberWet(const MirroredMesh& mirrored) {
  Unknowns unknowns;
  unknowns.of_vertex.assign(static_cast<std::size_t>(mirrored.mesh.vertexCount()), -1);
  for (Index v = 0; v < mirrored.image.size(); ++v)
    if (!isOnWaterline(mirrored, v)) unknowns.of_vertex[v] = unknowns.count++;
  return unknowns;
}

/// Numbers the unknowns of the wet part, and those of its images after them in the same order.
Unknowns numberBoth(const MirroredMesh& mirrored, const Unknowns& wet) {
  Unknowns both = wet;
  for (Index v = 0; v < mirrored.image.size(); ++v)
    if (!isOnWaterline(mirrored, v))
      both.of_vertex[mirrored.image[v]] = wet.count + wet.of_vertex[v];
  both.count = 2 * wet.count;
  return both;
}

/// W for odd jumps: of the wet part less that of its image, without its kernel.
Eigen::MatrixXd assembleOdd(const PanelSurface& surface, const MirroredMesh& mirrored,
                            const Unknowns& wet, const NearPanels& near) {
  const Index n = wet.count;
  const Eigen::MatrixXd W =
      assembleHypersingular(surface, numberBoth(mirrored, wet), near, kThreads);
  Eigen::MatrixXd odd = W.topLeftCorner(n, n) - W.bottomLeftCorner(n, n);
  fillKernel(surface, wet, odd);
  return odd;
}

/// mu at all vertices of the wet part and its image.
MatrixX6 solveOddJump(const PanelSurface& surface, const MirroredMesh& mirrored,
                      const NearPanels& near) {
  const Unknowns wet = numberWet(mirrored);
  const Eigen::LLT<Eigen::MatrixXd> factors(assembleOdd(surface, mirrored, wet, near));
  if (factors.info() != Eigen::Success)
    throw std::runtime_error(
        "the linear system is not positive definite; two sides of the surface are too close for "
        "the size of its panels");
  const MatrixX6 solution = factors.solve(-assembleNormalVelocity(surface, wet));
  MatrixX6 jump = MatrixX6::Zero(surface.vertexCount(), 6);
  for (Index v = 0; v < mirrored.image.size(); ++v) {
    if (isOnWaterline(mirrored, v)) continue;
    jump.row(v) = solution.row(wet.of_vertex[v]);
    jump.row(mirrored.image[v]) = -jump.row(v);
  }
  return jump;
}

/// -int g phi^T over the first panels.
Matrix6 integrate(const PanelSurface& surface, const PanelMoments& moments, Index panels) {
  Matrix6 K = Matrix6::Zero();
  for (Index t = 0; t < panels; ++t) {
    const Panel& panel = surface.panels[t];
    for (int a = 0; a < 3; ++a) {
      Vector6 g;
      g << panel.corner[a].cross(panel.normal), panel.normal;
      K -= g * moments[t].row(a);
    }
  }
  return 0.5 * (K + K.transpose());
}

}  // namespace

Matrix6 solveImageFlow(const TriangleMesh& body, int panels) {
  fixBlocksOfLargeProducts();
  const TriangleMesh coarse = wetPartOf(body);
  if (coarse.triangleCount() == 0) return Matrix6::Zero();
  const bool is_cut = (coarse.vertices.row(2).array() == 0).any();
  const TriangleMesh wet = refineSurface(coarse, is_cut, panels);
  const MirroredMesh mirrored = withImage(wet);
  const PanelSurface surface = makePanelSurface(mirrored.mesh, false);
  const NearPanels near = findNearPanels(surface, kThreads);
  const MatrixX6 jump = solveOddJump(surface, mirrored, near);
  const PanelMoments moments = computeExteriorMoments(surface, near, jump, kThreads);
  AMBIENT_ASSERT(jump.allFinite());
  const Matrix6 K = integrate(surface, moments, wet.triangleCount());
  return shiftOrigin(scaleShape(K, surface.length), -surface.centre);
}

}  // namespace ambient
