#include "preprocess/waterline/image_flow.h"

#include <Eigen/Cholesky>
#include <stdexcept>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/large_products.h"
#include "preprocess/potential_flow/operators/far_moments.h"
#include "preprocess/potential_flow/operators/hypersingular.h"
#include "preprocess/potential_flow/operators/near_moments.h"
#include "preprocess/potential_flow/surface/panel_surface.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "preprocess/waterline/wet_mesh.h"

namespace ambient {
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
        "the "
        "size of its panels: leave the table out, or take a sheet");
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
