#include "tests/preprocess/potential_flow/study/slamming/slamming_cases.h"

#include <cmath>
#include <vector>

#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient::study {
namespace {

TriangleMesh makeWedgeMesh(double deadrise, double length) {
  const double rise = kHalfBreadth * std::tan(deadrise);
  std::vector<Eigen::Vector3d> vertices;
  for (const double x : {-length / 2, length / 2}) {
    vertices.emplace_back(x, 0, 0);
    vertices.emplace_back(x, kHalfBreadth, rise);
    vertices.emplace_back(x, -kHalfBreadth, rise);
  }
  return makeTriangleMesh(
      vertices,
      {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}});
}

}  // namespace

SurfaceCase makeBallCase() { return makeSurfaceCase({"ball", ellipsoidMesh({1, 1, 1}, 500), 1}); }

SurfaceCase makeWedgeCase(double deadrise, double length) {
  return makeSurfaceCase({"wedge", makeWedgeMesh(deadrise, length), 0, kDefaultPanels});
}

double heaveInertia(const SurfaceModel& model, double draught, EntrySurface surface) {
  const Vector3 up = Vector3::UnitZ();
  const double low = immersionOf(model, {up, 0, 1, 1}).low;
  const Immersion at = immersionOf(model, {up, low + draught, 1, 1});
  return surface == EntrySurface::kRaised ? model.wetted->inertia(at)(5, 5)
                                          : model.wetted->unraisedInertia(at)(5, 5);
}

double slammingForce(const SurfaceModel& model, double draught, EntrySurface surface) {
  const double step = 1e-4 * draught;
  return (heaveInertia(model, draught + step, surface) -
          heaveInertia(model, draught - step, surface)) /
         (2 * step);
}

}  // namespace ambient::study
