#include "tests/study/reality/falling_cases.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/rotation.h"
#include "demos/simulation/simulation.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/resistance/known_viscous_flow.h"
#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {
namespace {

using nlohmann::json;

/// Mesh and numbers of a shape, axes along x, y, z.
struct FallingShape {
  TriangleMesh mesh;
  Vector3 size;  ///< full lengths; of a sheet z = 0 [m]
  /// Principal moments of a mass with these full lengths [kg m^2].
  Vector3 (*inertia)(double mass, const Vector3& size);
  std::optional<Matrix6> added_mass = {};  ///< per unit density; none: the flow is solved
  bool is_round = true;                    ///< false: a box or rectangle
  double sphere_radius = 0;
  KnownViscousFlow viscous_flow = {};

  double plan() const { return (is_round ? kPi / 4 : 1) * size.x() * size.y(); }
  double volume() const { return (is_round ? kPi / 6 : 1) * size.prod(); }
};

Matrix6 diagonal(const Vector3& rotation, const Vector3& translation) {
  Matrix6 made = Matrix6::Zero();
  made.diagonal() << rotation, translation;
  return made;
}

Matrix6 addedMassOfEllipsoid(const Vector3& semi_axes) {
  return ellipsoidAddedMass(semi_axes).asDiagonal();
}

Matrix6 addedMassOfDisc(double radius) {
  const double turn = 16 * portable::pow(radius, 5) / 45;
  return diagonal({turn, turn, 0}, {0, 0, 8 * portable::pow(radius, 3) / 3});
}

/// Elliptic cylinder of chord, span and thickness (x, y, z), flow in the x-z plane.
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

Vector3 inertiaOfEllipsoid(double mass, const Vector3& size) {
  const Vector3 q = (size / 2).cwiseAbs2();
  return mass / 5 * Vector3(q.y() + q.z(), q.z() + q.x(), q.x() + q.y());
}

Vector3 inertiaOfBall(double mass, const Vector3& size) {
  return Vector3::Constant(mass * size.x() * size.x() / 10);
}

Vector3 inertiaOfDisc(double mass, const Vector3& size) {
  return mass / 16 * size.x() * size.x() * Vector3(1, 1, 2);
}

Vector3 inertiaOfCylinder(double mass, const Vector3& size) {
  const double radius = size.x() / 2, height = size.z();
  const double across = mass * (3 * radius * radius + height * height) / 12;
  return {across, across, mass * radius * radius / 2};
}

FallingShape shapeOf(const Ellipsoid& e, int faces) {
  return {makeEllipsoidMesh(e.semi_axes, faces),
          2 * e.semi_axes,
          inertiaOfEllipsoid,
          addedMassOfEllipsoid(e.semi_axes),
          true,
          0,
          ellipsoidViscousFlow(e.semi_axes, addedMassOfEllipsoid(e.semi_axes))};
}

FallingShape shapeOf(const Sphere& s, int faces) {
  FallingShape made = shapeOf(Ellipsoid{Vector3::Constant(s.radius)}, faces);
  made.inertia = inertiaOfBall;
  made.sphere_radius = s.radius;
  return made;
}

FallingShape shapeOf(const EllipseSheet& e, int faces) {
  const double radius = e.semi_axes.x(), d = 2 * radius;
  return {makeEllipticSheetMesh(radius, radius, faces),
          {d, d, 0},
          inertiaOfDisc,
          addedMassOfDisc(radius)};
}

/// A coin, with the added mass of a disc.
FallingShape shapeOf(const Cylinder& c, int faces) {
  const double d = 2 * c.radius;
  return {makeCylinderMesh(c.radius, c.height, faces),
          {d, d, c.height},
          inertiaOfCylinder,
          addedMassOfDisc(c.radius),
          true,
          0,
          cylinderViscousFlow(c.radius, c.height, addedMassOfDisc(c.radius))};
}

FallingShape shapeOf(const Box& b, int faces) {
  return {makeBoxMesh(b.half_sizes, faces), 2 * b.half_sizes, inertiaOfBox, {}, false, 0,
          boxViscousFlow(b.half_sizes)};
}

FallingShape shapeOf(const RectangleSheet& r, int faces) {
  const double x = r.size.x(), y = r.size.y();
  return {makeRectangularSheetMesh(x, y, faces), {x, y, 0}, inertiaOfBox, {}, false};
}

template <class Other>
FallingShape shapeOf(const Other&, int) {
  throw std::runtime_error("no falls of this shape");
}

FluidBody bodyOf(const FallingShape& shape) {
  BuildSettings settings;
  settings.name = "falling body";
  settings.origin = Eigen::Vector3d::Zero();
  settings.flow.max_panels = 800;
  settings.flow.sheet = shape.size.z() == 0;
  settings.sphere_radius = shape.sphere_radius;
  settings.added_mass = shape.added_mass;
  settings.viscous_flow = shape.viscous_flow;
  return makeFluidBody(shape.mesh, settings);
}

double massOf(const json& fall, const FallingShape& shape, double scale) {
  if (fall.contains("mass")) return fall["mass"];
  if (!fall.contains("density"))
    return fall.at("mass_per_area").get<double>() * shape.size.x() * shape.size.y();
  return fall["density"].get<double>() * portable::pow(scale, 3) * shape.volume();
}

/// Zero without such a key.
Vector3 vectorOf(const json& fall, const char* key) {
  if (!fall.contains(key)) return Vector3::Zero();
  const auto v = fall[key].get<std::vector<double>>();
  return {v.at(0), v.at(1), v.at(2)};
}

/// Sets fluid, and in the unit fluid gravity, so that the terminal speed broadside is 1.
void immerse(FallingCase& falling, const std::string& fluid, double plan) {
  constexpr double kBroadside = 1.17;  // C_D
  falling.medium = fluid == "water" ? water()
                   : fluid == "air" ? air()
                                    : Medium{1, 1.0 / 2000, Vector3::Zero(), Vector3::Zero()};
  if (fluid != "unit") return;
  falling.gravity = kBroadside * plan / (2 * (falling.mass - falling.body->volume));
}

/// Makes the cases of a file; bodies of one shape share the flow.
class CaseReader {
 public:
  explicit CaseReader(std::string source) : source_(std::move(source)) {}

  void add(const json& fall) {
    const ShapeDescription description = readShape(fall.at("shape"), {}, source_);
    FallingShape shape = std::visit([&](const auto& s) { return shapeOf(s, description.faces); },
                                    description.geometry);
    if (fall.contains("added_mass")) shape.added_mass = addedMassOfStrip(shape.size);
    const double scale = fall.value("scale", 1.0);
    FallingCase falling{fall.at("family"), fall.at("name"), fall.at("parameter")};
    falling.body = scaledBody(description.text, shape, scale);
    falling.mass = massOf(fall, shape, scale);
    falling.inertia = shape.inertia(falling.mass, scale * shape.size);
    if (fall.value("hollow", false)) falling.inertia *= 5.0 / 3;
    falling.velocity = vectorOf(fall, "velocity");
    falling.spin = vectorOf(fall, "spin");
    falling.end = vectorOf(fall, "end");
    falling.roughness = fall.value("roughness", 0.0);
    immerse(falling, fall.at("fluid"), shape.plan());
    falling.time_step = 1 / fall.at("hertz").get<double>();
    falling.duration = fall.at("duration");
    falling.depth = fall.value("depth", 0.0);
    for (const json& tilt : fall.at("tilts")) {
      falling.tilt = tilt;
      falling.keeps_path = fall.value("keeps_path", 0.0) == falling.tilt;
      cases.push_back(falling);
    }
  }

  std::vector<FallingCase> cases;

 private:
  std::shared_ptr<const FluidBody> scaledBody(const std::string& text, const FallingShape& shape,
                                              double scale) {
    std::shared_ptr<const FluidBody>& body = bodies_[text];
    if (!body) body = std::make_shared<FluidBody>(bodyOf(shape));
    return scale == 1 ? body : std::make_shared<const FluidBody>(scaled(*body, scale));
  }

  std::string source_;
  std::map<std::string, std::shared_ptr<const FluidBody>> bodies_;  ///< by the text of their shape
};

}  // namespace

std::vector<FallingCase> readFallingCases(const std::filesystem::path& file,
                                          const std::string& group) {
  CaseReader reader(file.string());
  const json data = parseJson(readBytes(file), file.string());
  for (const json& known : data.at("groups")) {
    if (!group.empty() && known.at("name") != group) continue;
    for (const json& fall : known.at("falls")) {
      json whole = known.at("all");
      whole.update(fall);
      reader.add(whole);
    }
  }
  return reader.cases;
}

namespace {

const Vector3 kUp(0, 0, 1);

const char* nameOf(PressureLaw law) {
  return kPressureLawNames[static_cast<std::size_t>(law)].second;
}

Scene sceneOf(const FallingCase& c, PressureLaw law) {
  Scene scene;
  scene.name = c.family;
  scene.duration = c.duration;
  scene.time_step = c.time_step;
  scene.gravity = -c.gravity * kUp;
  scene.medium = c.medium;
  BodyDef body;
  body.name = c.name;
  body.shape.geometry = Sphere{1};  // it meets nothing
  body.mass = c.mass;
  body.orientation = rotationFromVector(c.tilt * kPi / 180 * Vector3::UnitY());
  body.linear_velocity = c.velocity;
  body.angular_velocity = c.spin;
  body.attach.medium = c.medium;
  body.attach.flow.roughness = c.roughness;
  body.attach.flow.law = law;
  scene.bodies = {body};
  return scene;
}

PreparedBody preparedOf(const FallingCase& c) {
  PreparedBody body;
  body.fluid_body = c.body;
  body.mass = c.mass;
  body.inertia = c.inertia.asDiagonal();
  return body;
}

/// Mean velocity over the second half.
Vector3 meanVelocity(const std::vector<MotionSample>& motion) {
  const MotionSample &from = motion[motion.size() / 2], &to = motion.back();
  return (to.position - from.position) / (to.time - from.time);
}

double meanSpin(const std::vector<MotionSample>& motion) {
  const std::size_t begin = motion.size() / 2;
  double sum = 0;
  for (std::size_t i = begin; i < motion.size(); ++i) sum += motion[i].twist.angular.y();
  return std::abs(sum) / static_cast<double>(motion.size() - begin);
}

/// Horizontal distance from the release at this depth; 0 if the body does not get there.
double reachAt(double depth, const std::vector<MotionSample>& motion) {
  for (const MotionSample& s : motion)
    if (depth > 0 && s.position.z() < -depth)
      return portable::hypot(s.position.x(), s.position.y());
  return 0;
}

}  // namespace

FallingRun runFall(const FallingCase& c, PressureLaw law) {
  Simulation simulation(sceneOf(c, law), {preparedOf(c)});
  const long steps = std::lround(c.duration / c.time_step);
  FallingRun run;
  for (long i = 0; i < steps; ++i) {
    simulation.step();
    run.motion.push_back(simulation.sample()[0]);
  }
  const std::vector<MotionSample> late(run.motion.begin() + steps / 2, run.motion.end());
  run.fall = analyseFall(late, kUp, -c.gravity * kUp);
  const AmbientCounters work = simulation.work(0);
  run.substeps = static_cast<double>(work.substeps) / static_cast<double>(steps);
  run.coarse = static_cast<double>(work.coarse) / static_cast<double>(steps);
  return run;
}

std::string fallHeader() {
  return "family,name,parameter,tilt,law,mode,descent,drift,spin,reach,miss,swing,substeps,"
         "coarse\n";
}

std::string fallLine(const FallingCase& c, PressureLaw law, const FallingRun& run) {
  const Vector3 velocity = meanVelocity(run.motion);
  char line[256];
  std::snprintf(line, sizeof line,
                "%s,\"%s\",%g,%g,%s,%s,%.4g,%.4g,%.4g,%.4g,%.4g,%.3g,%.3g,%.3g\n", c.family.c_str(),
                c.name.c_str(), c.parameter, c.tilt, nameOf(law),
                fallingModeName(run.fall.mode).c_str(), -velocity.z(),
                portable::hypot(velocity.x(), velocity.y()), meanSpin(run.motion),
                reachAt(c.depth, run.motion), (run.motion.back().position - c.end).norm(),
                run.fall.largest_swing * 180 / kPi, run.substeps, run.coarse);
  return line;
}

std::string pathHeader() { return "family,name,tilt,law,time,x,z,angle\n"; }

std::string pathLines(const FallingCase& c, PressureLaw law, const FallingRun& run) {
  constexpr std::size_t kEvery = 10;
  std::string lines;
  for (std::size_t i = 0; i < run.motion.size(); i += kEvery) {
    const MotionSample& s = run.motion[i];
    const Vector3 chord = s.orientation * Vector3::UnitX();
    char line[160];
    std::snprintf(line, sizeof line, "%s,%s,%g,%s,%.4g,%.5g,%.5g,%.4g\n", c.family.c_str(),
                  c.name.c_str(), c.tilt, nameOf(law), s.time, s.position.x(), s.position.z(),
                  portable::atan2(chord.z(), chord.x()));
    lines += line;
  }
  return lines;
}

}  // namespace ambient
