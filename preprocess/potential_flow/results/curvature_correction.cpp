#include "preprocess/potential_flow/results/curvature_correction.h"

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/potential_flow/surface/panel.h"
#include "preprocess/potential_flow/surface/quadrature_rules.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

Panel panelOf(const TriangleMesh& mesh, Index t) {
  return makePanel(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
}

/// Height of the smooth surface over a point of the face.
double heightAt(const Panel& face, const FaceBulge& bulge, const Vector3d& x) {
  Vector3d hat;
  for (int a = 0; a < 3; ++a) hat[a] = 1.0 / 3 + face.hatGradient(a).dot(x - face.centroid);
  return 4 * (bulge[0] * hat[0] * hat[1] + bulge[1] * hat[1] * hat[2] + bulge[2] * hat[2] * hat[0]);
}

/// Velocities of the six unit motions at x.
Matrix36 velocitiesAt(const Vector3d& x) {
  Matrix36 u;
  u << -crossMatrix(x), Eigen::Matrix3d::Identity();
  return u;
}

}  // namespace

CurvatureCorrection computeCurvatureCorrection(
    const TriangleMesh& mesh, const std::vector<FaceBulge>& bulges, const DividedSurface& panels,
    const Eigen::Matrix<double, Eigen::Dynamic, 6>& potential) {
  CurvatureCorrection correction;
  if (bulges.empty()) return correction;
  AMBIENT_ASSERT(static_cast<Index>(bulges.size()) == mesh.triangleCount());
  AMBIENT_ASSERT(potential.rows() == mesh.vertexCount() ||
                 potential.rows() == panels.mesh.vertexCount());
  for (Index t = 0; t < panels.mesh.triangleCount(); ++t) {
    const int face_number = panels.face[t];
    const Panel face = panelOf(mesh, face_number), panel = panelOf(panels.mesh, t);
    Matrix36 flow = Matrix36::Zero();  // along the panel
    for (int a = 0; a < 3; ++a)
      flow += panel.hatGradient(a) * potential.row(panels.mesh.triangles(a, t));
    const Eigen::Matrix3d along =
        Eigen::Matrix3d::Identity() - panel.normal * panel.normal.transpose();
    for (const TriangleNode& node : kTriangleRule6) {
      const Vector3d x = panel.at(node.barycentric);
      const double layer = node.weight * panel.area * heightAt(face, bulges[face_number], x);
      const Matrix36 u = velocitiesAt(x), slip = along * u - flow;
      correction.added_mass += layer * (slip.transpose() * slip - u.transpose() * u);
      correction.volume += layer;
    }
  }
  return correction;
}

}  // namespace ambient
