#include "tests/study/reality/measured_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/shape_builder.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {
namespace {

using Profile = std::vector<std::pair<double, double>>;
using Vector = Eigen::Vector3d;

constexpr int kSegments = 64;  // round the axis
constexpr int kRings = 24;     // along the profile

/// Collects vertices and triangles.
class MeshWriter {
 public:
  int addVertex(const Vector& p) {
    vertices_.push_back(p);
    return static_cast<int>(vertices_.size()) - 1;
  }
  // Adds a triangle unless it is degenerate, as at an axis.
  void addTriangle(int a, int b, int c) {
    if (a != b && b != c && c != a) triangles_.emplace_back(a, b, c);
  }
  void addQuad(int a, int b, int c, int d) {
    addTriangle(a, b, c);
    addTriangle(a, c, d);
  }
  TriangleMesh mesh() const { return makeTriangleMesh(vertices_, triangles_); }

 private:
  std::vector<Vector> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

/// Adds the ring of vertices of a profile point; an axis point is one vertex.
std::vector<int> addRing(MeshWriter& writer, double radius, double z) {
  if (radius <= 0) return std::vector<int>(kSegments, writer.addVertex({0, 0, z}));
  std::vector<int> ring;
  for (int i = 0; i < kSegments; ++i) {
    const double angle = 2 * kPi * i / kSegments;
    ring.push_back(
        writer.addVertex({radius * portable::cos(angle), radius * portable::sin(angle), z}));
  }
  return ring;
}

/// Half thickness of the NACA four-digit series over the thickness, closed at the tail; x from the
/// nose, over the chord.
double halfThickness(double x) {
  return 5 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x -
              0.1036 * x * x * x * x);
}

}  // namespace

TriangleMesh turnedMesh(const Profile& profile) {
  MeshWriter writer;
  std::vector<int> below;
  for (const auto& [radius, z] : profile) {
    const std::vector<int> ring = addRing(writer, radius, z);
    for (int i = 0; i < kSegments && !below.empty(); ++i) {
      const int next = (i + 1) % kSegments;
      writer.addQuad(below[i], below[next], ring[next], ring[i]);
    }
    below = ring;
  }
  return writer.mesh();
}

TriangleMesh hullMesh(const std::vector<Vector>& points) {
  return makeConvexHull(Eigen::Map<const Eigen::Matrix3Xd>(
                            points.front().data(), 3, static_cast<Eigen::Index>(points.size())),
                        "hull");
}

TriangleMesh prismMesh(const Profile& section, double length) {
  std::vector<Vector> corners;
  for (const double y : {-length / 2, length / 2})
    for (const auto& [x, z] : section) corners.emplace_back(x, y, z);
  return hullMesh(corners);
}

TriangleMesh aerofoilMesh(double thickness, double length) {
  Profile section{{0.5, 0}, {-0.5, 0}};
  constexpr int kPoints = kRings / 2;
  for (int i = 1; i < kPoints; ++i) {
    const double x = (1 - portable::cos(kPi * i / kPoints)) / 2, z = thickness * halfThickness(x);
    section.insert(section.end(), {{0.5 - x, z}, {0.5 - x, -z}});
  }
  return prismMesh(section, length);
}

TriangleMesh deltaMesh(double aspect_ratio, int faces) {
  constexpr double kTip = 0.02;
  TriangleMesh mesh = makeRectangularSheetMesh(1, 1, faces);
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i)
    mesh.vertices(1, i) *= aspect_ratio / 2 * std::max(0.5 - mesh.vertices(0, i), kTip);
  return mesh;
}

TriangleMesh shuttlecockMesh() {
  constexpr double kCork = 0.215, kShaft = 0.2;  // radius; length of its straight part
  Profile profile;
  for (int i = 0; i < kRings; ++i)
    profile.emplace_back(0.5 + (kCork - 0.5) * i / kRings, 1.0 * i / kRings);
  for (int i = 0; i < kRings; ++i) {
    const double angle = kPi / 2 * i / kRings;
    if (i == 0) profile.emplace_back(kCork, 1);
    profile.emplace_back(kCork * portable::cos(angle), 1 + kShaft + kCork * portable::sin(angle));
  }
  profile.emplace_back(0, 1 + kShaft + kCork);
  return turnedMesh(profile);
}

TriangleMesh hemisphereMesh(bool base) {
  Profile profile;
  for (int i = 0; base && i < kRings / 2; ++i) profile.emplace_back(1.0 * i / kRings, 0);
  for (int i = 0; i < kRings; ++i) {
    const double angle = kPi / 2 * i / kRings;
    profile.emplace_back(portable::cos(angle) / 2, portable::sin(angle) / 2);
  }
  profile.emplace_back(0, 0.5);
  return turnedMesh(profile);
}

TriangleMesh halfPipeMesh(double length) {
  MeshWriter writer;
  std::vector<int> before;
  for (int i = 0; i <= kRings; ++i) {
    const double angle = kPi * i / kRings;
    std::vector<int> line;
    for (int k = 0; k <= kSegments; ++k) {
      const double y = length * (1.0 * k / kSegments - 0.5);
      line.push_back(writer.addVertex({portable::cos(angle) / 2, y, portable::sin(angle) / 2}));
    }
    for (int k = 0; k < kSegments && i > 0; ++k)
      writer.addQuad(before[k], before[k + 1], line[k + 1], line[k]);
    before = line;
  }
  return writer.mesh();
}

TriangleMesh dropMesh(double length) {
  constexpr int kPoints = 2 * kRings;
  Profile profile{{0, -length / 2}};
  for (int i = kPoints - 1; i > 0; --i) {
    const double x = (1 - portable::cos(kPi * i / kPoints)) / 2;
    profile.emplace_back(halfThickness(x), length * (0.5 - x));
  }
  profile.emplace_back(0, length / 2);
  return turnedMesh(profile);
}

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
  // Divided before it is built, the sides of grains count as flat.
  return makeFluidBody(divideTriangles(meshOf(shape), common.least_faces), settings);
}

const FluidBody& measuredShape(const nlohmann::json& shape) {
  static std::map<std::string, FluidBody> made;
  const auto [found, is_new] = made.try_emplace(shape.dump());
  if (is_new) found->second = makeMeasuredShape(shape);
  return found->second;
}

namespace {

constexpr int kDirections = 200;

double radians(double degrees) { return degrees * kPi / 180; }

/// Direction of motion, in the plate's axes, at this incidence.
Vector3 atIncidence(double degrees) {
  return {portable::cos(radians(degrees)), 0, portable::sin(radians(degrees))};
}

double frontalArea(const FluidBody& body, const Vector3& direction) {
  if (body.sphere_radius > 0) return kPi * body.sphere_radius * body.sphere_radius;
  double area = 0;
  for (std::size_t i = 0; i < body.faces.size(); ++i)
    area += body.faces.area[i] * std::max(body.faces.normal(i).dot(direction), 0.0);
  return area;
}

/// Wind tunnel at some speed: a body in translation, or a spinning ball. Coefficients are those of
/// speed 1 times the speed squared.
class Tunnel {
 public:
  Tunnel(const FluidBody& body, const MeasuredFlow& flow, PressureLaw law) : body_(body) {
    FlowSettings settings;
    settings.law = law;
    settings.roughness = flow.roughness;
    const Medium fluid{1, flow.length / flow.reynolds, Vector3::Zero(), Vector3::Zero()};
    loads_ = makeSurfaceLoads(std::make_shared<FluidBody>(body), fluid, settings);
  }

  void setSpeed(double speed) { speed_ = speed; }
  /// Force over half the density.
  Vector3 force(const Vector3& direction) const {
    return 2 * load({Vector3::Zero(), direction}).force;
  }
  double drag(const Vector3& direction) const { return -force(direction).dot(direction); }
  /// `twist` at speed 1.
  Wrench load(const Twist& twist) const {
    return loads_->load({speed_ * twist.angular, speed_ * twist.linear});
  }

  double meanDrag() const {
    double sum = 0;
    for (int i = 0; i < kDirections; ++i) {  // points evenly on the sphere
      const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
      const double angle = kPi * (1 + std::sqrt(5.0)) * (i + 0.5);
      sum += drag({r * portable::cos(angle), r * portable::sin(angle), z});
    }
    return sum / kDirections / (kPi * portable::pow(3 * body_.volume / (4 * kPi), 2.0 / 3));
  }

  double stallAngle() const {
    double best = 0, largest = 0;
    for (double angle = 0.5; angle < 90; angle += 0.5) {
      const double lift = -force(atIncidence(angle)).dot(atIncidence(angle + 90));
      if (lift > largest) best = angle;
      largest = std::max(largest, lift);
    }
    return best;
  }

 private:
  const FluidBody& body_;
  double speed_ = 1;
  std::shared_ptr<const SurfaceLoads> loads_;
};

double ballCoefficient(const Tunnel& tunnel, const FluidBody& body, const MeasuredFlow& flow) {
  const double radius = body.sphere_radius, area = frontalArea(body, flow.velocity);
  const Twist twist{Vector3(0, 0, flow.spin / radius), Vector3(1, 0, 0)};
  const Wrench load = tunnel.load(twist);
  if (flow.of == "lift") return load.force.dot(Vector3(0, 1, 0)) / (0.5 * area);
  if (flow.of == "spin torque") return -load.torque.z() / (area * radius * flow.spin);
  return -load.force.x() / (0.5 * area);
}

}  // namespace

MeasuredFlow readMeasuredFlow(const nlohmann::json& flow) {
  MeasuredFlow read;
  read.of = flow.at("of").get<std::string>();
  const bool is_known = read.of == "drag" || read.of == "lift" || read.of == "normal" ||
                        read.of == "side" || read.of == "spin torque" || read.of == "stall angle";
  if (!is_known) throw std::invalid_argument("\"" + read.of + "\" is nothing that is measured");
  read.spin = flow.value("spin", 0.0);
  read.reynolds = flow.value("reynolds", read.reynolds);
  read.length = flow.value("length", read.length);
  read.roughness = flow.value("roughness", read.roughness);
  read.area = flow.value("area", read.area);
  if (flow.contains("incidence")) read.velocity = atIncidence(flow["incidence"].get<double>());
  read.is_mean = flow.contains("velocity") && flow["velocity"].is_string();
  if (flow.contains("velocity") && !read.is_mean) {
    const auto v = flow["velocity"].get<std::vector<double>>();
    read.velocity = Vector3(v.at(0), v.at(1), v.at(2)).normalized();
  }
  return read;
}

namespace {

double coefficientAt(const Tunnel& tunnel, const FluidBody& body, const MeasuredFlow& flow) {
  if (flow.of == "stall angle") return tunnel.stallAngle();
  if (body.sphere_radius > 0 && !flow.is_mean) return ballCoefficient(tunnel, body, flow);
  if (flow.is_mean) return tunnel.meanDrag();
  const Vector3 force = tunnel.force(flow.velocity), &v = flow.velocity;
  const Vector3 across(-v.z(), 0, v.x());
  const double plan = frontalArea(body, Vector3::UnitZ());
  if (flow.of == "normal") return -force.z() / plan;
  if (flow.of == "lift") return -force.dot(across) / plan;
  if (flow.of == "side") return -force.x() / (plan * v.x());
  return -force.dot(v) / (flow.area > 0 ? flow.area : frontalArea(body, v));
}

}  // namespace

double computeCoefficient(const FluidBody& body, const MeasuredFlow& flow, PressureLaw law) {
  return coefficientAt(Tunnel(body, flow, law), body, flow);
}

double computeSettling(const FluidBody& body, const MeasuredFlow& flow, double drag,
                       PressureLaw law) {
  Tunnel tunnel(body, flow, law);
  double slow = 1e-2, fast = 1e2;
  while (fast > slow * (1 + 1e-6)) {
    const double speed = std::sqrt(slow * fast);
    tunnel.setSpeed(speed);
    (coefficientAt(tunnel, body, flow) < drag ? slow : fast) = speed;
  }
  return slow;
}

}  // namespace ambient
