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

template <class Number, class Shape>
std::array<Number*, FormShape::kNumbers> numbersOf(Shape& shape) {
  std::array<Number*, FormShape::kNumbers> all{&shape.wing, &shape.edges, &shape.aspect,
                                               &shape.chord};
  std::size_t at = 4;
  for (auto* vector : {&shape.facing, &shape.span, &shape.slender, &shape.pitching, &shape.centre})
    for (Number& number : *vector) all[at++] = &number;
  return all;
}

template <class Number, class Form>
std::array<Number*, ViscousForm::kNumbers> viscousNumbersOf(Form& form) {
  std::array<Number*, ViscousForm::kNumbers> all;
  std::size_t at = 0;
  const auto add = [&](auto& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) all[at++] = matrix.data() + i;
  };
  add(form.resistance);
  add(form.centre_of_reaction);
  add(form.separation.axes);
  for (auto& way : form.separation.ways)
    for (Number* number :
         {&way.wake_laminar, &way.wake_bubble, &way.wake_turbulent, &way.wake_rough, &way.thickness,
          &way.friction_laminar, &way.friction_bubble, &way.friction_turbulent})
      all[at++] = number;
  add(form.separation.smooth_base);
  all[at++] = &form.surface.diameter;
  add(form.surface.frontal);
  add(form.surface.moments);
  add(form.surface.gyration);
  all[at] = &form.sharp_share;
  return all;
}

template <class Number, class Part>
std::array<Number*, Wing::kNumbers> wingNumbersOf(Part& wing) {
  std::array<Number*, Wing::kNumbers> all;
  std::size_t at = 0;
  const auto add = [&](auto& vector) {
    for (Number& number : vector) all[at++] = &number;
  };
  add(wing.facing);
  add(wing.span_axis);
  add(wing.centre);
  for (Number* number : {&wing.span, &wing.chord, &wing.thickness, &wing.aspect, &wing.body_lift})
    all[at++] = number;
  return all;
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

std::array<double*, FormShape::kNumbers> FormShape::numbers() { return numbersOf<double>(*this); }

std::array<const double*, FormShape::kNumbers> FormShape::numbers() const {
  return numbersOf<const double>(*this);
}

double Wing::plateMass() const {
  const double long_side = std::max(aspect, 1 / aspect), square = 1 + long_side * long_side;
  const double of_strip = long_side / std::sqrt(square) * (1 - 0.425 * long_side / square);
  return kPi / 4 * chord * chord * span * std::min(1.0, aspect) * of_strip;
}

std::array<double*, Wing::kNumbers> Wing::numbers() { return wingNumbersOf<double>(*this); }

std::array<const double*, Wing::kNumbers> Wing::numbers() const {
  return wingNumbersOf<const double>(*this);
}

std::array<double*, ViscousForm::kNumbers> ViscousForm::numbers() {
  return viscousNumbersOf<double>(*this);
}

std::array<const double*, ViscousForm::kNumbers> ViscousForm::numbers() const {
  return viscousNumbersOf<const double>(*this);
}

Eigen::Matrix<double, Eigen::Dynamic, 6> computeSlipMatrix(const FaceTable& faces) {
  const auto face_count = static_cast<Eigen::Index>(faces.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> slip(3 * face_count, 6);
  for (Eigen::Index i = 0; i < face_count; ++i) {
    const Vector3 n = faces.normal(static_cast<std::size_t>(i));
    const Vector3 c = faces.centroid(static_cast<std::size_t>(i));
    const Matrix3 tangential = Matrix3::Identity() - n * n.transpose();
    slip.block<3, 3>(3 * i, 0) = tangential * crossMatrix(c);  // u_s = -P (v + w x c)
    slip.block<3, 3>(3 * i, 3) = -tangential;
  }
  return slip;
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

void appendWings(const FluidBody& body, std::string& bytes) {
  if (body.wings.empty()) return;
  const auto append = [&bytes](const double* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(double));
  };
  for (const Wing& wing : body.wings) {
    for (const double* number : wing.numbers()) append(number, 1);
    bytes += wing.is_joined ? '\1' : '\0';
    if (wing.nose == 0 && wing.camber == 0) continue;
    append(&wing.camber, 1);
    append(&wing.nose, 1);
  }
  for (const double* number : body.form.rest.numbers()) append(number, 1);
  append(body.form.wing_shares.data(), body.form.wing_shares.size());
  bytes.append(body.form.part_of_face.begin(), body.form.part_of_face.end());
  bytes.append(body.part_of_triangle.begin(), body.part_of_triangle.end());
}

}  // namespace

std::uint64_t contentHash(const FluidBody& body) {
  std::string bytes;
  const auto append = [&bytes](const double* values, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(values), count * sizeof(double));
  };
  append(body.added_mass.data(), 36);
  append(&body.volume, 1);
  append(&body.area, 1);
  append(body.centre_of_volume.data(), 3);
  const auto appendFaces = [&append](const FaceTable& faces) {
    for (const std::vector<double>* column : faces.columns())
      append(column->data(), column->size());
    append(faces.sharpness.data(), faces.sharpness.size());
  };
  appendFaces(body.faces);
  if (body.form.faces.size() > 0)
    for (const double* number : body.form.shape.numbers()) append(number, 1);
  appendFaces(body.form.faces);
  if (body.viscous.isKnown()) {
    for (const double* number : body.viscous.numbers()) append(number, 1);
    bytes += body.viscous.is_primitive ? '\1' : '\0';
  }
  for (const FormLevel& level : body.form_levels) appendFaces(level.faces);
  if (!body.drag.isZero(0)) append(body.drag.data(), 3);
  if (body.sphere_radius > 0) append(&body.sphere_radius, 1);
  append(body.surface.vertices.data(), body.surface.vertices.size());
  bytes.append(reinterpret_cast<const char*>(body.surface.triangles.data()),
               body.surface.triangles.size() * sizeof(std::int32_t));
  bytes.append(reinterpret_cast<const char*>(body.form.hull.data()),
               body.form.hull.size() * sizeof(std::int32_t));
  for (const AddedMassPart& part : body.added_mass_parts.all()) {
    append(part.centre.data(), 3);
    append(part.spread.data(), 6);
    append(part.inertia.data(), 36);
  }
  append(body.waterline.immersions.data(), body.waterline.immersions.size());
  for (const Matrix6& correction : body.waterline.corrections) append(correction.data(), 36);
  const auto appendTriangles = [&](const std::vector<double>& places,
                                   const std::vector<std::int32_t>& triangles) {
    append(places.data(), places.size());
    bytes.append(reinterpret_cast<const char*>(triangles.data()),
                 triangles.size() * sizeof(std::int32_t));
  };
  for (const Hold& hold : body.holds) {
    appendTriangles(hold.surface.vertices, hold.surface.triangles);
    for (const HoldOpening& opening : hold.openings) {
      appendTriangles(opening.outline, opening.lid);
      bytes.append(reinterpret_cast<const char*>(&opening.to), sizeof opening.to);
    }
  }
  appendWings(body, bytes);
  return fnv1a64(bytes);
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
