#include "tests/preprocess/potential_flow/study/image_flow/surface_cases.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/weld_vertices.h"
#include "preprocess/waterline/waterline_builder.h"
#include "tests/preprocess/potential_flow/study/study_meshes.h"

namespace ambient::study {
namespace {

using Eigen::Vector3d;

/// Hull of length 4, breadth 1.2 [m]: parabolic waterlines and sections from the keel at z = -0.6
/// to z = 0, walls up to the deck at z = 0.4.
TriangleMesh makeHullMesh() {
  constexpr int kStations = 16, kRows = 5;
  constexpr double kHalfLength = 2, kHalfBreadth = 0.6, kDepth = 0.6, kFreeboard = 0.4;
  constexpr int kAround = 2 * kRows + 3;  // deck, keel, deck
  std::vector<Vector3d> vertices;
  for (int i = 0; i <= kStations; ++i)
    for (int j = 0; j < kAround; ++j) {
      const double x = 2.0 * i / kStations - 1;
      const int down = std::abs(j - (kRows + 1));  // 0: keel; kRows: z = 0
      const double z = down > kRows ? kFreeboard / kDepth : 1.0 * down / kRows - 1;
      const double section = 1 - std::pow(std::min(z, 0.0), 2), side = j > kRows + 1 ? 1 : -1;
      vertices.emplace_back(kHalfLength * x, side * kHalfBreadth * (1 - x * x) * section,
                            kDepth * z);
    }
  std::vector<Eigen::Vector3i> triangles;
  const auto vertex = [&](int station, int around) { return station * kAround + around % kAround; };
  appendGridTriangles(kStations, kAround, vertex, triangles);
  return weldVertices(makeTriangleMesh(vertices, triangles), 1e-9 * kHalfLength);
}

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
  mesh.vertices.colwise() -= Vector3d(body->origin);
  return {def.shape, std::move(mesh), modelOf(body)};
}

SurfaceCase withWaterline(const SurfaceCase& body, int subdivisions) {
  FluidBody tabulated = *body.model.shape;
  WaterlineSettings settings;
  settings.subdivisions = subdivisions;
  tabulated.waterline = makeWaterlineTable(tabulated, settings);
  return {body.shape, body.mesh, modelOf(std::make_shared<const FluidBody>(std::move(tabulated)))};
}

std::vector<SurfaceCase> surfaceCases() {
  const auto ellipsoid = [](const Vector3d& semi_axes) {
    return scaledToVolume(makeEllipsoidMesh(semi_axes, 500), 4 * kPi / 3 * semi_axes.prod());
  };
  std::vector<SurfaceCase> cases;
  cases.push_back(makeSurfaceCase({"sphere", ellipsoid({1, 1, 1}), 1}));
  cases.push_back(makeSurfaceCase({"cube", makeBoxMesh({1, 1, 1}, 12)}));
  cases.push_back(makeSurfaceCase({"box 4 : 2 : 1", makeBoxMesh({2, 1, 0.5}, 12)}));
  cases.push_back(makeSurfaceCase({"cylinder, height 2 diameters", makeCylinderMesh(0.5, 2, 300)}));
  cases.push_back(makeSurfaceCase({"ellipsoid 5 : 4 : 3", ellipsoid({1.25, 1, 0.75})}));
  cases.push_back(makeSurfaceCase({"hull with a deck", makeHullMesh()}));
  return cases;
}

}  // namespace ambient::study
