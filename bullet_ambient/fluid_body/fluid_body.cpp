#include "bullet_ambient/fluid_body/fluid_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

namespace {

void scale(std::vector<double>& column, double factor) {
  for (double& value : column) value *= factor;
}

void scale(FaceTable& faces, double factor) {
  for (std::vector<double>* column : {&faces.centroid_x, &faces.centroid_y, &faces.centroid_z})
    scale(*column, factor);
  scale(faces.area, factor * factor);
}

/// Places of numbers in the order in which they were added, those of a matrix by columns.
template <std::size_t kCount>
struct Places {
  std::array<double*, kCount> of;
  std::size_t next = 0;

  void add(double& number) { of[next++] = &number; }
  void add(SeparationWay& way) {
    for (double* number :
         {&way.wake_laminar, &way.wake_bubble, &way.wake_turbulent, &way.wake_rough, &way.thickness,
          &way.friction_laminar, &way.friction_bubble, &way.friction_turbulent})
      add(*number);
  }
  template <class List>
  void add(List& list) {
    const auto size = static_cast<std::size_t>(list.size());
    for (std::size_t i = 0; i < size; ++i) add(list.data()[i]);
  }
};

template <std::size_t kCount, class... Parts>
std::array<double*, kCount> placesOf(Parts&... parts) {
  Places<kCount> places;
  (places.add(parts), ...);
  return places.of;
}

/// Returns numbers() of a part that does not change.
template <class Part>
std::array<const double*, Part::kNumbers> constNumbersOf(const Part& part) {
  const auto places = const_cast<Part&>(part).numbers();
  std::array<const double*, Part::kNumbers> numbers;
  std::copy(places.begin(), places.end(), numbers.begin());
  return numbers;
}

void scale(Wing& wing, double factor) {
  wing.centre *= factor;
  for (double* length : {&wing.span, &wing.chord, &wing.thickness}) *length *= factor;
}

void scale(ViscousForm& form, double factor) {
  form.resistance = scaleResistance(form.resistance, factor);
  form.centre_of_reaction *= factor;
  form.surface.diameter *= factor;
  form.surface.frontal *= factor * factor;
  form.surface.moments *= factor * factor;
  form.surface.gyration *= factor * factor;
}

// The mass stays 1 kg, so that the inertia grows with the square.
void scale(MassDistribution& mass, double factor) {
  mass.centre *= factor;
  mass.inertia *= factor * factor;
}

void scale(Hold& hold, double factor) {
  const double cube = factor * factor * factor;
  scale(hold.surface.vertices, factor);
  hold.volume *= cube;
  hold.centre *= factor;
  hold.turning_inertia *= cube * factor * factor;
  for (HoldOpening& opening : hold.openings) scale(opening.outline, factor);
}

}  // namespace

void FaceTable::reserve(std::size_t faces) {
  for (std::vector<double>* column : {&normal_x.own(), &normal_y.own(), &normal_z.own(),
                                      &centroid_x, &centroid_y, &centroid_z, &area})
    column->reserve(faces);
}

void FaceTable::add(const Vector3& face_normal, const Vector3& face_centroid, double face_area) {
  normal_x.own().push_back(face_normal.x());
  normal_y.own().push_back(face_normal.y());
  normal_z.own().push_back(face_normal.z());
  centroid_x.push_back(face_centroid.x());
  centroid_y.push_back(face_centroid.y());
  centroid_z.push_back(face_centroid.z());
  area.push_back(face_area);
}

double FormShape::pitchingArm(const Vector3& normal, const Vector3& place) const {
  return pitching.dot((place - centre).cross(normal));
}

std::array<double*, FormShape::kNumbers> FormShape::numbers() {
  return placesOf<kNumbers>(wing, edges, aspect, chord, facing, span, slender, pitching, centre);
}

std::array<const double*, FormShape::kNumbers> FormShape::numbers() const {
  return constNumbersOf(*this);
}

double Wing::plateMass() const {
  const double long_side = std::max(aspect, 1 / aspect), square = 1 + long_side * long_side;
  const double of_strip = long_side / std::sqrt(square) * (1 - 0.425 * long_side / square);
  return kPi / 4 * chord * chord * span * std::min(1.0, aspect) * of_strip;
}

std::array<double*, Wing::kNumbers> Wing::numbers() {
  return placesOf<kNumbers>(facing, span_axis, centre, span, chord, thickness, aspect, body_lift);
}

std::array<const double*, Wing::kNumbers> Wing::numbers() const { return constNumbersOf(*this); }

std::array<double*, ViscousForm::kNumbers> ViscousForm::numbers() {
  return placesOf<kNumbers>(resistance, centre_of_reaction, separation.axes, separation.ways,
                            separation.smooth_base, surface.diameter, surface.frontal,
                            surface.moments, surface.gyration, sharp_share);
}

std::array<const double*, ViscousForm::kNumbers> ViscousForm::numbers() const {
  return constNumbersOf(*this);
}

Vector3 axisOfRevolution(const FluidBody& body) {
  constexpr double kStill = 1e-3;  // added mass over the inertia of the displaced fluid
  const Matrix6 about_centre = shiftOrigin(body.added_mass, body.centre_of_volume);
  const SymmetricEigen<3> spins = symmetricEigen<3>(about_centre.topLeftCorner<3, 3>());
  const auto isStill = [&](int spin) {
    const Vector3 axis = spins.vectors.col(spin);
    return std::abs(spins.values[spin]) <
           kStill * body.volume * axis.dot(body.uniform_mass.inertia * axis);
  };
  return isStill(0) && !isStill(1) ? Vector3(spins.vectors.col(0)) : Vector3::Zero();
}

FluidBody scaled(const FluidBody& body, double factor) {
  if (!(factor > 0) || !std::isfinite(factor))
    reject(body, "factor of scaled()", factor, "positive and finite");
  FluidBody result = body;
  result.added_mass = scaleShape(body.added_mass, factor);
  result.volume *= factor * factor * factor;
  result.area *= factor * factor;
  if (!result.added_mass.allFinite() || !std::isfinite(result.volume + result.area) ||
      (result.area > 0) != (body.area > 0) || (result.volume > 0) != (body.volume > 0)) {
    reject(body, "factor of scaled()", factor,
           "one that leaves its area, volume and added mass finite and above zero");
  }
  result.centre_of_volume *= factor;
  result.origin *= factor;
  scale(result.uniform_mass, factor);
  scale(result.surface_mass, factor);
  scale(result.faces, factor);
  scale(result.surface.vertices, factor);
  for (FormShape* shape : {&result.form.shape, &result.form.rest}) {
    shape->chord *= factor;
    shape->centre *= factor;
  }
  scale(result.form.faces, factor);
  scale(result.viscous, factor);
  result.sphere_radius *= factor;
  result.added_mass_parts = body.added_mass_parts.scaled(factor);
  for (Matrix6& correction : result.waterline.corrections)
    correction = scaleShape(correction, factor);
  for (Hold& hold : result.holds) scale(hold, factor);
  for (Wing& wing : result.wings) scale(wing, factor);
  for (FormLevel& level : result.form_levels) scale(level.faces, factor);
  std::ostringstream settings;
  settings.precision(17);
  settings << body.provenance.settings << "; scaled by " << factor;
  result.provenance.settings = settings.str();
  return result;
}

Vector3 extentsOf(const FluidBody& body) {
  const std::vector<double>& v = body.surface.vertices;
  const auto count = static_cast<Eigen::Index>(v.size() / 3);
  if (count == 0) return Vector3::Zero();
  const Eigen::Map<const Eigen::Matrix3Xd> vertices(v.data(), 3, count);
  return vertices.rowwise().maxCoeff() - vertices.rowwise().minCoeff();
}

FaceTable facesOf(const FluidBody& body) {
  if (!body.omits_faces) return body.faces;
  const std::vector<std::int32_t>& triangles = body.surface.triangles;
  const auto corner = [&](std::size_t i) {
    return Vector3(&body.surface.vertices[3 * static_cast<std::size_t>(triangles[i])]);
  };
  FaceTable faces;
  faces.reserve(triangles.size() / 3);
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const Vector3 a = corner(t), b = corner(t + 1), c = corner(t + 2);
    const Vector3 twice_area = (b - a).cross(c - a);
    faces.add(twice_area.normalized(), (a + b + c) / 3, twice_area.norm() / 2);
  }
  return faces;
}

std::shared_ptr<const FluidBody> withFaces(const std::shared_ptr<const FluidBody>& body) {
  if (!body->omits_faces) return body;
  FluidBody whole = *body;
  whole.faces = facesOf(*body);
  whole.omits_faces = false;
  return std::make_shared<const FluidBody>(std::move(whole));
}

void reject(const FluidBody& body, const std::string& what, double value, const char* limit) {
  std::ostringstream message;
  message << "fluid body '" << body.name << "': " << what << " is " << value << ", must be "
          << limit;
  throw std::invalid_argument(message.str());
}

bool isPrepared(const FluidBody& body) {
  if (body.sphere_radius > 0) return true;
  const std::size_t labels = body.wings.empty() ? 0 : body.form.faces.size();
  if (body.form.part_of_face.size() != labels) return false;
  return (body.faces.size() == 0 || body.form.faces.size() > 0) &&
         (body.surface.triangles.empty() || !body.form.hull.empty());
}

void requirePrepared(const FluidBody& body) {
  if (isPrepared(body)) return;
  throw std::invalid_argument("fluid body '" + body.name +
                              "' is not prepared: call prepare() of preprocess/build.h, or upgrade "
                              "its file with ambient_preprocess upgrade");
}

namespace {

/// Bytes of what a hash is made of.
class HashedBytes {
 public:
  template <class Number>
  void addNumber(const Number& number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  /// Adds the entries of a list or a matrix.
  template <class List>
  void addAll(const List& list) {
    const auto size = static_cast<std::size_t>(list.size()) * sizeof *list.data();
    bytes_.append(reinterpret_cast<const char*>(list.data()), size);
  }
  template <class Part>
  void addNumbersOf(const Part& part) {
    for (const double* number : part.numbers()) addNumber(*number);
  }
  void addFaces(const FaceTable& faces) {
    for (const std::vector<double>* column : faces.columns()) addAll(*column);
    addAll(faces.sharpness);
  }
  std::uint64_t hash() const { return fnv1a64(bytes_); }

 private:
  std::string bytes_;
};

void addHolds(const std::vector<Hold>& holds, HashedBytes& bytes) {
  for (const Hold& hold : holds) {
    bytes.addAll(hold.surface.vertices);
    bytes.addAll(hold.surface.triangles);
    for (const HoldOpening& opening : hold.openings) {
      bytes.addAll(opening.outline);
      bytes.addAll(opening.lid);
      bytes.addNumber(opening.to);
    }
  }
}

void addWings(const FluidBody& body, HashedBytes& bytes) {
  if (body.wings.empty()) return;
  for (const Wing& wing : body.wings) {
    bytes.addNumbersOf(wing);
    bytes.addNumber(wing.is_joined);
    if (wing.nose == 0 && wing.camber == 0) continue;
    bytes.addNumber(wing.camber);
    bytes.addNumber(wing.nose);
  }
  bytes.addNumbersOf(body.form.rest);
  bytes.addAll(body.form.wing_shares);
  bytes.addAll(body.form.part_of_face);
  bytes.addAll(body.part_of_triangle);
}

}  // namespace

std::uint64_t contentHash(const FluidBody& body) {
  HashedBytes bytes;
  bytes.addAll(body.added_mass);
  bytes.addNumber(body.volume);
  bytes.addNumber(body.area);
  bytes.addAll(body.centre_of_volume);
  bytes.addFaces(body.faces);
  if (body.form.faces.size() > 0) bytes.addNumbersOf(body.form.shape);
  bytes.addFaces(body.form.faces);
  if (body.viscous.isKnown()) {
    bytes.addNumbersOf(body.viscous);
    bytes.addNumber(body.viscous.is_primitive);
  }
  for (const FormLevel& level : body.form_levels) bytes.addFaces(level.faces);
  if (!body.drag.isZero(0)) bytes.addAll(body.drag);
  if (body.sphere_radius > 0) bytes.addNumber(body.sphere_radius);
  bytes.addAll(body.surface.vertices);
  bytes.addAll(body.surface.triangles);
  bytes.addAll(body.form.hull);
  for (const AddedMassPart& part : body.added_mass_parts.all()) {
    bytes.addAll(part.centre);
    bytes.addAll(part.spread);
    bytes.addAll(part.inertia);
  }
  bytes.addAll(body.waterline.immersions);
  for (const Matrix6& correction : body.waterline.corrections) bytes.addAll(correction);
  addHolds(body.holds, bytes);
  addWings(body, bytes);
  return bytes.hash();
}

double boxTurning(double a, double b) noexcept {
  constexpr double kPi5 = kPi * kPi * kPi * kPi * kPi;
  const double ratio = std::sqrt(std::max(a, b) / std::min(a, b));
  const double decay = portable::exp(-kPi * ratio);
  const double tanh = (1 - decay) / (1 + decay);  // of half of that
  const double part = 1 + ratio * ratio;
  const double share =
      std::isfinite(ratio) ? 1 - 4 / part + 768 / kPi5 * (tanh + 0.0045) / (ratio * part) : 1;
  return (a + b) / 12 * share;
}

}  // namespace ambient
