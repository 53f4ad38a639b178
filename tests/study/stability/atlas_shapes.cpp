#include "tests/study/stability/atlas_shapes.h"

#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/shapes/primitives.h"

namespace ambient {
namespace {

constexpr double kRightAngle = kPi / 2;
constexpr int kFaces = 400;
constexpr int kPanels = 800;  // enough for stability; accuracy is not needed

using Deformation = std::function<Vector3(const Vector3&)>;

TriangleMesh deformed(TriangleMesh mesh, const Deformation& deformation) {
  for (Eigen::Index i = 0; i < mesh.vertexCount(); ++i)
    mesh.vertices.col(i) = deformation(mesh.vertices.col(i));
  return mesh;
}

// Deformation that turns cross sections about x by an angle proportional to x.
Deformation twist(double angle_per_length) {
  return [=](const Vector3& p) {
    const double angle = angle_per_length * p.x();
    const double c = portable::cos(angle), s = portable::sin(angle);
    return Vector3(p.x(), c * p.y() - s * p.z(), s * p.y() + c * p.z());
  };
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  const double a = 1 / std::sqrt(8.0);  // makes edges of 1 m
  mesh.vertices.resize(3, 4);
  mesh.vertices << a, a, -a, -a, a, -a, a, -a, a, -a, -a, a;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 1, 1, 3, 2, 3, 2, 1, 3, 2;
  return mesh;
}

AtlasShape makeShape(const std::string& name, const TriangleMesh& mesh, bool sheet = false) {
  BuildSettings settings;
  settings.name = name;
  settings.flow.sheet = sheet;
  settings.least_faces = kFaces;
  settings.flow.max_panels = kPanels;
  AtlasShape shape;
  shape.name = name;
  const TriangleMesh checked = requireSound(checkMesh(mesh, name, sheet), name).mesh;
  auto body = std::make_shared<FluidBody>(makeFluidBody(checked, settings));
  shape.solid_volume = sheet ? 0.01 * body->area / 2 : body->volume;
  shape.half_size =
      (checked.vertices.rowwise().maxCoeff() - checked.vertices.rowwise().minCoeff()) / 2;
  shape.separation_angle = kRightAngle;
  shape.body = std::move(body);
  return shape;
}

// Needle with its added mass in closed form.
AtlasShape makeNeedle() {
  const Vector3 half_size(0.5, 0.0005, 0.0005);
  ShapeDescription description;
  description.geometry = Ellipsoid{half_size};
  description.faces = kFaces;
  ShapeBuildSettings settings;
  settings.name = "needle";
  AtlasShape shape;
  shape.name = settings.name;
  shape.body = std::make_shared<FluidBody>(buildShape(description, settings).body);
  shape.solid_volume = shape.body->volume;
  shape.half_size = half_size;
  shape.separation_angle = kRightAngle;
  return shape;
}

}  // namespace

std::vector<AtlasShape> makeAtlasShapes() {
  std::vector<AtlasShape> shapes;
  shapes.push_back(makeShape("sphere", makeEllipsoidMesh({0.5, 0.5, 0.5}, kFaces)));
  shapes.push_back(makeShape("plate 5:1", makeEllipsoidMesh({0.5, 0.5, 0.1}, kFaces)));
  shapes.push_back(makeShape("plate 200:1", makeEllipsoidMesh({0.5, 0.5, 0.0025}, kFaces)));
  shapes.push_back(makeShape("sheet", makeEllipticSheetMesh(0.5, 0.5, kFaces / 2), true));
  shapes.push_back(makeShape("cone", makeConeMesh(0.5, 1, kFaces)));
  shapes.back().separation_angle = 1.5 * kRightAngle;
  shapes.push_back(makeShape(
      "propeller", deformed(makeBoxMesh({0.5, 0.1, 0.02}, kFaces), twist(2 * kRightAngle / 2))));
  shapes.push_back(makeShape("chiral body",
                             deformed(makeBoxMesh({0.5, 0.2, 0.12}, kFaces), [](const Vector3& p) {
                               return twist(1.2)(p + Vector3(0, 0.3 * p.x() * p.x(), 0.2 * p.y()));
                             })));
  shapes.push_back(makeShape("tetrahedron", tetrahedron()));
  shapes.push_back(makeNeedle());
  return shapes;
}

}  // namespace ambient
