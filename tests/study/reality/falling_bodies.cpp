#include "tests/study/reality/falling_bodies.h"

#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

namespace ambient {
namespace {

Matrix6 diagonal(const Vector3& rotation, const Vector3& translation) {
  Matrix6 made = Matrix6::Zero();
  made.diagonal() << rotation, translation;
  return made;
}

std::shared_ptr<const FluidBody> bodyOf(const TriangleMesh& mesh, BuildSettings settings) {
  settings.name = "falling body";
  settings.origin = Eigen::Vector3d::Zero();
  settings.flow.max_panels = 800;
  return std::make_shared<FluidBody>(makeFluidBody(mesh, settings));
}

}  // namespace

std::shared_ptr<const FluidBody> sheetOf(const TriangleMesh& mesh,
                                         const std::optional<Matrix6>& added_mass) {
  BuildSettings settings;
  settings.flow.sheet = true;
  settings.added_mass = added_mass;
  return bodyOf(mesh, settings);
}

std::shared_ptr<const FluidBody> solidOf(const TriangleMesh& mesh,
                                         const std::optional<Matrix6>& added_mass) {
  BuildSettings settings;
  settings.added_mass = added_mass;
  return bodyOf(mesh, settings);
}

std::shared_ptr<const FluidBody> ballOf(double radius) {
  BuildSettings settings;
  settings.sphere_radius = radius;
  settings.added_mass = addedMassOfEllipsoid(Vector3::Constant(radius));
  return bodyOf(makeEllipsoidMesh(Vector3::Constant(radius), 320), settings);
}

Matrix6 addedMassOfEllipsoid(const Vector3& semi_axes) {
  return ellipsoidAddedMass(semi_axes).asDiagonal();
}

Matrix6 addedMassOfDisc(double radius) {
  const double turn = 16 * portable::pow(radius, 5) / 45;
  return diagonal({turn, turn, 0}, {0, 0, 8 * portable::pow(radius, 3) / 3});
}

Matrix6 addedMassOfStrip(const Vector3& size) {
  const double a = size.x() / 2, c = size.z() / 2, span = size.y();
  const double turn = kPi / 8 * portable::pow(a * a - c * c, 2) * span;
  const double x = kPi * c * c * span, z = kPi * a * a * span;
  return diagonal({z * span * span / 12, turn, x * span * span / 12}, {x, 0, z});
}

Vector3 inertiaOfBox(double mass, const Vector3& size) {
  const Vector3 squares = size.cwiseProduct(size);
  return mass / 12 * (Vector3::Constant(squares.sum()) - squares);
}

}  // namespace ambient
