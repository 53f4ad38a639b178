#include "tests/preprocess/potential_flow/study/image_flow/surface_cases.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/waterline/waterline_builder.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient::study {
namespace {

SurfaceModel modelOf(const std::shared_ptr<const FluidBody>& body) {
  SurfaceModelDef model;
  model.shape = body;
  const double mass = 0.5 * body->volume;
  model.mass = {mass, mass * body->uniform_mass.inertia};
  model.below = {1, 0, {0, 0, 0}, {0, 0, 0}};
  model.flow.own_law = [](const auto&, const auto&) { return nullptr; };
  return makeSurfaceModel(model);
}

}  // namespace

SurfaceCase makeSurfaceCase(const SurfaceCaseDef& def) {
  BuildSettings settings;
  settings.name = def.shape;
  settings.sphere_radius = def.sphere_radius;
  settings.flow.max_panels = def.panels;
  settings.flow.threads = 1;
  const auto body = std::make_shared<const FluidBody>(makeFluidBody(def.mesh, settings));
  TriangleMesh mesh = def.mesh;
  mesh.vertices.colwise() -= body->origin;
  return {def.shape, std::move(mesh), modelOf(body)};
}

SurfaceCase withWaterline(const SurfaceCase& body, int subdivisions) {
  FluidBody tabulated = *body.model.shape;
  WaterlineSettings settings;
  settings.subdivisions = subdivisions;
  tabulated.waterline = makeWaterlineTable(tabulated, settings);
  return {body.shape, body.mesh, modelOf(std::make_shared<const FluidBody>(std::move(tabulated)))};
}

TriangleMesh scaledToVolume(TriangleMesh mesh, double volume) {
  mesh.vertices *= std::cbrt(volume / test::volumeOf(mesh));
  return mesh;
}

TriangleMesh ellipsoidMesh(const Vector3& semi_axes, int faces) {
  return scaledToVolume(makeEllipsoidMesh(semi_axes, faces), 4 * kPi / 3 * semi_axes.prod());
}

Matrix6 imageInertia(const SurfaceCase& body, const SurfacePlane& plane, int panels) {
  return body.model.above.inertia +
         body.model.excess_density * solveImageFlow(body.mesh, plane, panels);
}

double largestError(const Matrix6& inertia, const Matrix6& reference) {
  const Eigen::LLT<Matrix6> root(reference);
  const Matrix6 half = root.matrixL().solve(inertia);
  const Matrix6 ratio = root.matrixL().solve(half.transpose());
  const Vector6 values = symmetricEigen<6>(0.5 * (ratio + ratio.transpose())).values;
  return (values.array() - 1).abs().maxCoeff();
}

double floatingHeight(const SurfaceModel& model, const Vector3& normal) {
  double low = -model.radius, high = model.radius;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    const double wet = immersionOf(model, {normal, middle, 1, 1}).wet.volume;
    (wet < 0.5 * model.shape->volume ? low : high) = middle;
  }
  return low;
}

}  // namespace ambient::study
