#include "preprocess/hand_over/handed_body.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/base/output_file.h"
#include "preprocess/polar/polar.h"

namespace ambient {

std::string numberText(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number + 0.0).ptr};  // no -0
}

std::string roundedText(double number, int digits) {
  char text[32];
  return {text,
          std::to_chars(text, text + sizeof text, number + 0.0, std::chars_format::general, digits)
              .ptr};
}

std::string fixedText(double number, int digits) {
  char text[400];
  const std::string signed_text(
      text, std::to_chars(text, text + sizeof text, number, std::chars_format::fixed, digits).ptr);
  const bool is_zero = signed_text.find_first_not_of("-0.") == std::string::npos;
  return is_zero && signed_text[0] == '-' ? signed_text.substr(1) : signed_text;
}

Matrix6 linearFirst(const Matrix6& rotation_first) {
  Matrix6 K;
  K << rotation_first.bottomRightCorner<3, 3>(), rotation_first.bottomLeftCorner<3, 3>(),
      rotation_first.topRightCorner<3, 3>(), rotation_first.topLeftCorner<3, 3>();
  return K;
}

namespace {

void requirePositive(const FluidBody& body, const char* what, double value) {
  if (!(value > 0) || !std::isfinite(value)) reject(body, what, value, "positive and finite");
}

void checkAxes(const FluidBody& body, const ExportSettings& settings) {
  constexpr double kRounding = 1e-9;
  for (const Vector3& axis : {settings.forward, settings.up})
    if (!(std::abs(axis.norm() - 1) <= kRounding))
      reject(body, "length of a forward or upward axis", axis.norm(), "1");
  const double along = settings.forward.dot(settings.up);
  if (!(std::abs(along) <= kRounding)) reject(body, "forward axis times upward axis", along, "0");
}

void checkSettings(const FluidBody& body, const ExportSettings& settings) {
  requirePositive(body, "density of the fluid [kg/m^3]", settings.medium.density);
  requirePositive(body, "gravity [m/s^2]", settings.gravity);
  if (const auto fault = faultOf(settings.medium))
    reject(body, std::string(fault->quantity) + " [" + fault->unit + "]", fault->value,
           fault->limit);
  if (settings.mass) requirePositive(body, "mass [kg]", *settings.mass);
  if (settings.draught) requirePositive(body, "draught [m]", *settings.draught);
  if (settings.speed) requirePositive(body, "speed [m/s]", *settings.speed);
  if (settings.centre_of_mass && !settings.centre_of_mass->allFinite())
    reject(body, "distance of the centre of mass [m]", settings.centre_of_mass->norm(), "finite");
  checkAxes(body, settings);
  if (settings.draught && body.added_mass_parts.empty() && !(body.sphere_radius > 0))
    reject(body, "number of added-mass parts, which a draught needs,", 0,
           "above 0: build the body anew from its mesh or shape");
}

// Returns the wet volume of a body that is all in the fluid.
WetVolume allWet(const FluidBody& shape) {
  WetVolume wet;
  wet.volume = shape.volume;
  wet.moment = shape.volume * shape.centre_of_volume;
  return wet;
}

Immersion immersionOf(const FluidBody& shape, const SurfacePlane& deep, double draught) {
  Immersion at{deep, 0, 0, {}};
  const double radius = shape.sphere_radius, middle = deep.normal.dot(shape.centre_of_volume);
  const PackedHull hull(shape);
  std::tie(at.low, at.high) =
      radius > 0 ? std::pair(middle - radius, middle + radius) : computeExtent(hull, deep.normal);
  at.plane.height = at.low + draught;
  if (draught >= at.size())
    at.wet = allWet(shape);
  else
    at.wet = radius > 0 ? computeWetSphere(radius, shape.centre_of_volume, at.plane)
                        : computeWetVolume(hull, at.plane);
  return at;
}

// Sets the surface, what of the body is below it, and the added mass there.
void putAtSurface(HandedBody& body) {
  const Immersion at = immersionOf(*body.shape, body.plane, *body.settings.draught);
  const Matrix6 wet = makeWettedInertia(body.shape)->unraisedInertia(at);
  body.plane = at.plane;
  body.wet = at.wet;
  body.added_mass = body.settings.medium.density * wet;
}

// Sets mass and inertia.
void putMass(HandedBody& body) {
  const FluidBody& shape = *body.shape;
  const MassDistribution& spread = shape.volume > 0 ? shape.uniform_mass : shape.surface_mass;
  const double displaced = body.settings.medium.density * body.wet.volume;
  if (!body.settings.mass && !(displaced > 0))
    reject(shape, "displaced mass [kg]", displaced, "positive, or the mass must be given");
  body.weight.mass = body.settings.mass.value_or(displaced);
  body.weight.centre = body.settings.centre_of_mass.value_or(spread.centre);
  body.inertia = body.weight.mass * spread.inertia;
}

void checkFinite(const HandedBody& body) {
  const Matrix6 stiffness = restoringStiffness(body.wet, body.plane, body.weight, Vector3::Zero());
  for (const Matrix6& matrix : {body.added_mass, body.ownInertia(), stiffness})
    if (!matrix.allFinite())
      reject(*body.shape, "largest entry of inertia and stiffness", HUGE_VAL,
             "finite: density, gravity, mass or the distance of its centre is too large");
}

std::string plainName(const std::string& name) {
  std::string plain = name.empty() ? "body" : name;
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '.' ||
           c == '-';
  };
  std::replace_if(
      plain.begin(), plain.end(), [&](char c) { return !is_plain(c); }, '_');
  return plain;
}

}  // namespace

Matrix3 HandedBody::axes() const { return flightAxes(settings.forward, settings.up); }

Vector3 HandedBody::middle() const {
  return wet.volume > 0 ? Vector3(wet.moment / wet.volume) : shape->surface_mass.centre;
}

Matrix6 HandedBody::ownInertia() const {
  return FrameOffset{Matrix3::Identity(), weight.centre}.inertiaToB(
      rigidBodyInertia(weight.mass, inertia));
}

HandedBody handedBody(const std::shared_ptr<const FluidBody>& shape,
                      const ExportSettings& settings) {
  checkSettings(*shape, settings);
  HandedBody body;
  body.shape = shape;
  body.settings = settings;
  body.name = plainName(shape->name);
  body.plane = {settings.up, 0, settings.medium.density, settings.gravity};
  if (settings.draught) {
    putAtSurface(body);
  } else {
    body.wet = allWet(*shape);
    body.added_mass = settings.medium.density * shape->added_mass;
  }
  putMass(body);
  checkFinite(body);
  AMBIENT_ASSERT(isSymmetric(body.added_mass, 1e-9) && isSymmetric(body.inertia, 1e-9));
  return body;
}

namespace {

std::string element(const std::string& name, double value) {
  return "          <" + name + ">" + numberText(value) + "</" + name + ">\n";
}

// The upper half of a symmetric matrix, an element per entry. Their names are those of the rows and
// columns after a prefix.
std::string elements(const char* prefix, const char* letters, const Matrix6& matrix, int size) {
  std::string text;
  for (int i = 0; i < size; ++i)
    for (int j = i; j < size; ++j)
      text += element(std::string(prefix) + letters[i] + letters[j], matrix(i, j));
  return text;
}

}  // namespace

ExportedBody makeSdf(const HandedBody& body) {
  Matrix6 inertia = Matrix6::Zero();
  inertia.topLeftCorner<3, 3>() = body.inertia;
  return {
      "<?xml version=\"1.0\"?>\n"
      "<sdf version=\"1.10\">\n"
      "  <model name=\"" +
          body.name +
          "\">\n"
          "    <link name=\"" +
          body.name +
          "\">\n"
          "      <inertial>\n"
          "        <pose>" +
          rowText(body.weight.centre) +
          " 0 0 0</pose>\n"
          "        <mass>" +
          numberText(body.weight.mass) +
          "</mass>\n"
          "        <inertia>\n" +
          elements("i", "xyz", inertia, 3) +
          "        </inertia>\n"
          "        <fluid_added_mass>\n" +
          elements("", "xyzpqr", linearFirst(body.added_mass), 6) +
          "        </fluid_added_mass>\n"
          "      </inertial>\n"
          "    </link>\n"
          "  </model>\n"
          "</sdf>\n",
      ""};
}

namespace {

// SNAME's body axes in F: forward, to starboard, down.
Matrix3 bodyAxes(const HandedBody& body) {
  const Matrix3 axes = body.axes();
  Matrix3 sname;
  sname << axes.col(0), -axes.col(1), -axes.col(2);
  return sname;
}

Matrix6 inBodyAxes(const Matrix6& matrix_F, const Matrix3& axes) {
  return linearFirst(rotateAxes(matrix_F, axes.transpose()));
}

/// Entries "key": value of one JSON object. Keys and texts have no letters to be escaped.
class JsonObject {
 public:
  void text(const char* key, const std::string& value) { add(key, "\"" + value + "\""); }
  void number(const char* key, double value) { add(key, numberText(value)); }
  template <class Vector>
  void row(const char* key, const Vector& value) {
    add(key, "[" + rowText(value, ", ") + "]");
  }
  template <class Matrix>
  void matrix(const char* key, const Matrix& value) {
    std::string rows;
    for (Eigen::Index i = 0; i < value.rows(); ++i)
      rows += (i > 0 ? ",\n    [" : "\n    [") + rowText(value.row(i), ", ") + "]";
    add(key, "[" + rows + "\n  ]");
  }
  std::string finished() const { return "{\n" + entries_ + "\n}\n"; }

 private:
  void add(const std::string& key, const std::string& value) {
    entries_ += (entries_.empty() ? "  \"" : ",\n  \"") + key + "\": " + value;
  }
  std::string entries_;
};

void addHydrostatics(JsonObject& json, const HandedBody& body, const Matrix3& axes) {
  if (body.settings.draught) json.number("draught", *body.settings.draught);
  json.number("displaced_volume", body.wet.volume);
  if (body.wet.volume > 0)
    json.row("centre_of_buoyancy", Vector3(axes.transpose() * body.middle()));
  json.number("waterplane_area", body.wet.waterplane.area);
  json.matrix(
      "G",
      inBodyAxes(restoringStiffness(body.wet, body.plane, body.weight, Vector3::Zero()), axes));
}

void addDrag(JsonObject& json, const HandedBody& body, const Matrix3& axes) {
  const double speed = *body.settings.speed;
  const BodyLoads loads(body.shape, body.settings.medium, {});
  const Twist motion{Vector3::Zero(), speed * body.settings.forward};
  const Wrench load = loads.at(motion).total();
  const Matrix6 damping = loads.dampingAt(motion);
  // Loads of a sphere are 0 beyond that.
  const bool has_pressure = std::isfinite(body.settings.medium.density * speed * speed);
  if (!has_pressure || !load.vector().allFinite() || !damping.allFinite())
    reject(*body.shape, "speed [m/s]", speed, "small enough for a finite drag");
  json.number("speed", speed);
  json.matrix("D", inBodyAxes(damping, axes));
  json.row("tau", stack(axes.transpose() * load.force, axes.transpose() * load.torque));
}

}  // namespace

ExportedBody makeFossen(const HandedBody& body) {
  const Matrix3 axes = bodyAxes(body);
  JsonObject json;
  json.text("name", body.name);
  json.text("frame",
            "body axes of SNAME: x forward, y to starboard, z down; origin: that of the .ambient "
            "file");
  json.text("order", "u v w p q r");
  json.number("density", body.settings.medium.density);
  json.number("gravity", body.settings.gravity);
  json.number("mass", body.weight.mass);
  json.row("centre_of_gravity", Vector3(axes.transpose() * body.weight.centre));
  json.matrix("M_RB", inBodyAxes(body.ownInertia(), axes));
  json.matrix("M_A", inBodyAxes(body.added_mass, axes));
  addHydrostatics(json, body, axes);
  if (body.settings.speed) addDrag(json, body, axes);
  return {json.finished(), ""};
}

ExportFormat exportFormatOf(const std::string& name) {
  if (const auto format = valueOf(kExportFormatNames, name)) return *format;
  throw std::invalid_argument("\"" + name + "\" is none of sdf, mjcf, fossen");
}

void ExportedBody::write(const std::filesystem::path& file) const { writeFile(file, bytes); }

ExportedBody exportFluidBody(const std::shared_ptr<const FluidBody>& body, ExportFormat format,
                             const ExportSettings& settings) {
  if (settings.speed && format != ExportFormat::kFossen)
    reject(*body, "speed [m/s]", *settings.speed, "given for fossen only");
  const HandedBody handed = handedBody(body, settings);
  switch (format) {
    case ExportFormat::kSdf:
      return makeSdf(handed);
    case ExportFormat::kMjcf:
      return makeMjcf(handed);
    case ExportFormat::kFossen:
      return makeFossen(handed);
  }
  AMBIENT_ASSERT(false);
  return {};
}

}  // namespace ambient
