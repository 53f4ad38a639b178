#include "tests/study/reality/measured_shapes.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/study/reality/measured_meshes.h"

namespace ambient {
namespace {

constexpr int kMeshFaces = 4000;
constexpr double kLong = 100;  // length for "infinite" in sources

struct Made {
  TriangleMesh mesh;
  bool sheet = false;
  double sphere_radius = 0;
};

TriangleMesh cuboctahedron() {
  std::vector<Eigen::Vector3d> corners;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-1.0, 1.0}) {
      corners.insert(corners.end(), {{a, b, 0}, {a, 0, b}, {0, a, b}});
    }
  }
  return hullMesh(corners);
}

/// Regular prism of hexagons of width 1 across the corners, two of them at +z and -z.
TriangleMesh hexagonalRod() {
  const double x = std::sqrt(3.0) / 4;
  return prismMesh({{0, 0.5}, {0, -0.5}, {x, 0.25}, {x, -0.25}, {-x, 0.25}, {-x, -0.25}}, kLong);
}

/// Elliptic cylinder along z of width 1 and this depth along x.
TriangleMesh ellipticRod(double depth) {
  TriangleMesh mesh = makeCylinderMesh(0.5, kLong, kMeshFaces);
  mesh.vertices.row(0) *= depth;
  return mesh;
}

TriangleMesh cone(double half_angle) {
  return makeConeMesh(0.5, 0.5 / portable::tan(half_angle * kPi / 180), kMeshFaces);
}

Made meshOf(const std::string& type, double x) {
  const auto sheet = [](TriangleMesh mesh) { return Made{std::move(mesh), true}; };
  if (type == "ball") return {makeEllipsoidMesh({0.5, 0.5, 0.5}, 320), false, 0.5};
  if (type == "cube") return {makeBoxMesh({0.5, 0.5, 0.5}, kMeshFaces)};
  if (type == "rod") return {makeBoxMesh({x / 2, kLong / 2, 0.5}, kMeshFaces)};
  if (type == "plate") return sheet(makeRectangularSheetMesh(1, x, kMeshFaces));
  if (type == "disc") return sheet(makeEllipticSheetMesh(0.5, 0.5, kMeshFaces));
  if (type == "cylinder") return {makeCylinderMesh(0.5, x, kMeshFaces)};
  if (type == "cone") return {cone(x)};
  if (type == "spheroid") return {makeEllipsoidMesh({0.5, 0.5, x / 2}, kMeshFaces)};
  if (type == "hemisphere") return {hemisphereMesh(true)};
  if (type == "cup") return sheet(hemisphereMesh(false));
  if (type == "half pipe") return sheet(halfPipeMesh(kLong));
  if (type == "hexagonal rod") return {hexagonalRod()};
  if (type == "elliptic rod") return {ellipticRod(x)};
  if (type == "aerofoil rod") return {aerofoilMesh(x, kLong)};
  if (type == "delta") return sheet(deltaMesh(x, kMeshFaces));
  if (type == "shuttlecock") return sheet(shuttlecockMesh());
  if (type == "drop") return {dropMesh(x)};
  if (type == "octahedron")
    return {hullMesh({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})};
  if (type == "tetrahedron") return {hullMesh({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}})};
  if (type == "cuboctahedron") return {cuboctahedron()};
  if (type == "triangular rod")
    return {prismMesh({{-0.5, 0}, {0.5, 0}, {0, std::sqrt(3.0) / 2}}, kLong)};
  throw std::invalid_argument("shape \"" + type + "\" is not known");
}

}  // namespace

FluidBody makeMeasuredShape(const std::string& type, double size) {
  const Made made = meshOf(type, size);
  BuildSettings settings;
  settings.name = type;
  settings.flow.sheet = made.sheet;
  settings.sphere_radius = made.sphere_radius;
  if (made.sphere_radius > 0) settings.added_mass = Matrix6::Zero();
  settings.flow.max_panels = 1000;
  settings.least_faces = made.sphere_radius > 0 ? 0 : 1000;
  return makeFluidBody(made.mesh, settings);
}

}  // namespace ambient
