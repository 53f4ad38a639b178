#include "tests/study/reality/measured_shapes.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/study/reality/measured_meshes.h"

namespace ambient {
namespace {

constexpr int kMeshFaces = 4000;
constexpr double kLong = 100;  // length for "infinite" in sources

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

/// Sharp-edged hull of 24 points on an ellipsoid, with the ellipsoid's volume.
TriangleMesh angularGrain(const Vector3& size) {
  constexpr int kCorners = 24;
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double z = 1 - (2 * i + 1.0) / kCorners, r = std::sqrt(1 - z * z);
    const double angle = kPi * (1 + std::sqrt(5.0)) * (i + 0.5);
    corners.push_back(
        size.cwiseProduct(Vector3(r * portable::cos(angle), r * portable::sin(angle), z)) / 2);
  }
  TriangleMesh mesh = hullMesh(corners);
  const double volume = computeMassProperties(mesh).volume;
  mesh.vertices *= portable::cbrt(kPi / 6 * size.prod() / volume);
  return mesh;
}

/// The shape as data/schema/shape.schema.json has it; null: that has none such.
nlohmann::json primitiveOf(const nlohmann::json& shape) {
  const std::string type = shape.at("type");
  const double x = shape.value("size", 1.0);
  const double half_width = shape.value("width", 1.0) / 2;
  const double half_thickness = shape.value("thickness", 1.0) / 2;
  const auto box = [](double length, double width) {
    return nlohmann::json{{"type", "box"}, {"size", {length, width, 1}}};
  };
  if (type == "ball") return {{"type", "sphere"}, {"radius", 0.5}};
  if (type == "cube") return box(1, 1);
  if (type == "rod") return box(x, kLong);
  if (type == "plate") return {{"type", "sheet"}, {"size", {1, x}}};
  if (type == "disc") return {{"type", "sheet"}, {"semi_axes", {0.5, 0.5}}};
  if (type == "cylinder") return {{"type", "cylinder"}, {"radius", 0.5}, {"height", x}};
  if (type == "cone")
    return {{"type", "cone"}, {"radius", 0.5}, {"height", 0.5 / portable::tan(x * kPi / 180)}};
  if (type == "spheroid") return {{"type", "ellipsoid"}, {"semi_axes", {0.5, 0.5, x / 2}}};
  if (type == "ellipsoid")
    return {{"type", "ellipsoid"}, {"semi_axes", {0.5, half_width, half_thickness}}};
  return nullptr;
}

TriangleMesh meshOf(const nlohmann::json& shape) {
  const std::string type = shape.at("type");
  const double x = shape.value("size", 1.0);
  if (type == "hemisphere") return hemisphereMesh(true);
  if (type == "cup") return hemisphereMesh(false);
  if (type == "half pipe") return halfPipeMesh(kLong);
  if (type == "hexagonal rod") return hexagonalRod();
  if (type == "elliptic rod") return ellipticRod(x);
  if (type == "aerofoil rod") return aerofoilMesh(x, kLong);
  if (type == "delta") return deltaMesh(x, kMeshFaces);
  if (type == "shuttlecock") return shuttlecockMesh();
  if (type == "drop") return dropMesh(x);
  if (type == "turned") return turnedMesh(shape.at("profile"));
  if (type == "grain")
    return angularGrain({1, shape.at("width").get<double>(), shape.at("thickness").get<double>()});
  if (type == "octahedron")
    return hullMesh({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
  if (type == "tetrahedron") return hullMesh({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}});
  if (type == "cuboctahedron") return cuboctahedron();
  if (type == "triangular rod")
    return prismMesh({{-0.5, 0}, {0.5, 0}, {0, std::sqrt(3.0) / 2}}, kLong);
  throw std::invalid_argument("shape \"" + type + "\" is not known");
}

}  // namespace

FluidBody makeMeasuredShape(const nlohmann::json& shape) {
  CommonBuildSettings common;
  common.name = shape.at("type");
  common.flow.max_panels = 1000;
  common.least_faces = common.name == "ball" ? 0 : 1000;
  nlohmann::json primitive = primitiveOf(shape);
  if (!primitive.is_null()) {
    primitive["faces"] = kMeshFaces;
    ShapeBuildSettings settings;
    static_cast<CommonBuildSettings&>(settings) = common;
    return buildShape(readShape(primitive, {}, common.name), settings).body;
  }
  BuildSettings settings;
  static_cast<CommonBuildSettings&>(settings) = common;
  settings.flow.sheet = common.name == "cup" || common.name == "half pipe" ||
                        common.name == "delta" || common.name == "shuttlecock";
  return makeFluidBody(meshOf(shape), settings);
}

}  // namespace ambient
