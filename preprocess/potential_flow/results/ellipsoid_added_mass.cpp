#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

#include <array>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/mass_properties.h"

namespace ambient {

// Every step brings the arguments four times closer together; when they are one, R_D = z^(-3/2).
double integralD(Vector3 arguments) {
  constexpr int kSteps = 32;
  double sum = 0, weight = 1;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3 roots = arguments.cwiseSqrt();
    const double shift = roots.x() * roots.y() + roots.y() * roots.z() + roots.z() * roots.x();
    sum += weight / (roots.z() * (arguments.z() + shift));
    weight /= 4;
    arguments = (arguments.array() + shift) / 4;
  }
  return 3 * sum + weight / portable::pow(arguments.z(), 1.5);
}

Vector6 ellipsoidAddedMass(const Vector3& semi_axes) {
  AMBIENT_ASSERT(semi_axes.minCoeff() > 0 && semi_axes.allFinite());
  const double size = semi_axes.maxCoeff();
  const Vector3 axes = semi_axes / size, squares = axes.cwiseAbs2();
  const double volume = 4 * kPi / 3 * axes.prod();
  Vector3 demagnetisation;  // Lamb's alpha_0, beta_0, gamma_0; their sum is 2
  for (int k = 0; k < 3; ++k) {
    demagnetisation[k] =
        2.0 / 3 * axes.prod() * integralD({squares[(k + 1) % 3], squares[(k + 2) % 3], squares[k]});
  }
  Vector6 K = Vector6::Zero();
  AMBIENT_ASSERT(demagnetisation.minCoeff() >= 0 && std::abs(demagnetisation.sum() - 2) < 1e-9);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    K[3 + k] = volume * demagnetisation[k] / (2 - demagnetisation[k]) * portable::pow(size, 3);
    const double difference = squares[i] - squares[j];
    if (difference == 0) continue;  // a body of revolution about k moves no fluid when it spins
    const double twist = demagnetisation[j] - demagnetisation[i];
    K[k] = volume / 5 * difference * difference * twist /
           (2 * difference - (squares[i] + squares[j]) * twist) * portable::pow(size, 5);
  }
  return K;
}

namespace {

PanelInertia ellipsoidPanel(const TriangleCorners& corners, const Vector3& translation,
                            const Vector3& rotation) {
  const std::array<Vector3, 3> corner{corners.col(0), corners.col(1), corners.col(2)};
  const Vector3 twice_area = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  PanelInertia panel;
  panel.normal = twice_area.normalized();
  panel.centroid = (corner[0] + corner[1] + corner[2]) / 3;
  panel.area = twice_area.norm() / 2;
  for (std::size_t k = 0; k < 3; ++k) {  // the rule of the edges' middles
    const Vector3 z = (corner[k] + corner[(k + 1) % 3]) / 2, r = z - panel.centroid;
    const Vector3 bilinear(z.y() * z.z(), z.z() * z.x(), z.x() * z.y());
    Vector6 phi;
    phi << rotation.cwiseProduct(bilinear), translation.cwiseProduct(z);
    panel.inertia -= panel.area / 3 * stack(z.cross(panel.normal), panel.normal) * phi.transpose();
    Vector6 products;
    products << r.cwiseAbs2(), r.x() * r.y(), r.x() * r.z(), r.y() * r.z();
    panel.spread += products / 3;
  }
  return panel;
}

}  // namespace

std::vector<PanelInertia> ellipsoidPanels(const TriangleMesh& mesh, const Vector3& semi_axes) {
  const Vector6 K = ellipsoidAddedMass(semi_axes);
  const double volume = 4 * kPi / 3 * semi_axes.prod();
  const Vector3 squares = semi_axes.cwiseAbs2();
  Vector3 rotation(0, 0, 0);  // phi_i = rotation_i z_j z_k
  for (int i = 0; i < 3; ++i) {
    const double difference = squares[(i + 1) % 3] - squares[(i + 2) % 3];
    if (difference != 0) rotation[i] = -5 * K[i] / (volume * difference);
  }
  std::vector<PanelInertia> panels;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    panels.push_back(ellipsoidPanel(cornersOf(mesh, t), -K.tail<3>() / volume, rotation));
  return panels;
}

std::vector<PanelInertia> simplePanels(const TriangleMesh& mesh, const Vector6& K) {
  AMBIENT_ASSERT(K.minCoeff() >= 0);
  std::vector<PanelInertia> panels;
  Vector6 sum = Vector6::Zero();
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const TriangleCorners corners = cornersOf(mesh, t);
    const Vector3 n =
        (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).normalized();
    const Vector3 n2 = n.cwiseAbs2();
    const Vector3 rotation(n2.y() - n2.z(), n2.z() - n2.x(), n2.x() - n2.y());
    panels.push_back(ellipsoidPanel(corners, -Vector3::Ones(), rotation));
    sum += panels.back().inertia.diagonal();
  }
  Vector6 factor = Vector6::Zero();
  for (int i = 0; i < 6; ++i)
    if (K[i] > 0 && sum[i] > 0) factor[i] = K[i] / sum[i];
  for (PanelInertia& panel : panels) panel.inertia *= factor.asDiagonal();
  return panels;
}

std::vector<AddedMassPart> estimateParts(TriangleMesh mesh, const Matrix6& added_mass) {
  const Vector3 centre = computeMassProperties(mesh).uniform.centre;
  mesh.vertices.colwise() -= centre;
  const Matrix6 about_centre = shiftOrigin(added_mass, centre);
  return placed(joinPanels(simplePanels(mesh, about_centre.diagonal())), 1, centre);
}

}  // namespace ambient
