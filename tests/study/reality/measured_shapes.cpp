#include "tests/study/reality/measured_shapes.h"

#include <cmath>
#include <functional>
#include <map>
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

using Maker = std::function<Made(double)>;

const std::map<std::string, Maker>& makers() {
  using Points = std::vector<Eigen::Vector3d>;
  static const Points octahedron{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                 {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  static const Points tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  static const std::map<std::string, Maker> made{
      {"ball",
       [](double) {
         return Made{makeEllipsoidMesh({0.5, 0.5, 0.5}, 320), false, 0.5};
       }},
      {"cube",
       [](double) {
         return Made{makeBoxMesh({0.5, 0.5, 0.5}, kMeshFaces)};
       }},
      {"rod",
       [](double x) {
         return Made{makeBoxMesh({x / 2, kLong / 2, 0.5}, kMeshFaces)};
       }},
      {"plate",
       [](double x) {
         return Made{makeRectangularSheetMesh(1, x, kMeshFaces), true};
       }},
      {"disc",
       [](double) {
         return Made{makeEllipticSheetMesh(0.5, 0.5, kMeshFaces), true};
       }},
      {"cylinder", [](double x) { return Made{makeCylinderMesh(0.5, x, kMeshFaces)}; }},
      {"cone", [](double x) { return Made{cone(x)}; }},
      {"spheroid",
       [](double x) {
         return Made{makeEllipsoidMesh({0.5, 0.5, x / 2}, kMeshFaces)};
       }},
      {"hemisphere", [](double) { return Made{hemisphereMesh(true)}; }},
      {"cup",
       [](double) {
         return Made{hemisphereMesh(false), true};
       }},
      {"half pipe",
       [](double) {
         return Made{halfPipeMesh(kLong), true};
       }},
      {"hexagonal rod", [](double) { return Made{hexagonalRod()}; }},
      {"elliptic rod", [](double x) { return Made{ellipticRod(x)}; }},
      {"aerofoil rod", [](double x) { return Made{aerofoilMesh(x, kLong)}; }},
      {"delta",
       [](double x) {
         return Made{deltaMesh(x, kMeshFaces), true};
       }},
      {"shuttlecock",
       [](double) {
         return Made{shuttlecockMesh(), true};
       }},
      {"drop", [](double x) { return Made{dropMesh(x)}; }},
      {"octahedron", [](double) { return Made{hullMesh(octahedron)}; }},
      {"tetrahedron", [](double) { return Made{hullMesh(tetrahedron)}; }},
      {"cuboctahedron", [](double) { return Made{cuboctahedron()}; }},
      {"triangular rod", [](double) {
         return Made{prismMesh({{-0.5, 0}, {0.5, 0}, {0, std::sqrt(3.0) / 2}}, kLong)};
       }}};
  return made;
}

}  // namespace

FluidBody makeMeasuredShape(const std::string& type, double size) {
  const auto maker = makers().find(type);
  if (maker == makers().end()) throw std::invalid_argument("shape \"" + type + "\" is not known");
  const Made made = maker->second(size);
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
