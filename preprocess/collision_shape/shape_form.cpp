#include "preprocess/collision_shape/shape_form.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"

namespace ambient {

namespace {

/// The lengths of a shape, to read and to change. The letter tells its kind in contentOf().
struct Lengths {
  char kind = 0;
  std::vector<double*> sizes = {};
  std::vector<Eigen::Vector3d*> points = {};
};

/// Addresses of the items of a list.
template <class List>
auto addressesOf(List& list) {
  std::vector<decltype(&*list.begin())> addresses;
  addresses.reserve(static_cast<std::size_t>(list.size()));
  for (auto& item : list) addresses.push_back(&item);
  return addresses;
}

struct LengthFinder {
  Lengths operator()(Sphere& s) const { return {'a', {&s.radius}}; }
  Lengths operator()(Box& s) const { return {'b', addressesOf(s.half_sizes)}; }
  Lengths operator()(Cylinder& s) const { return {'c', {&s.radius, &s.height}}; }
  Lengths operator()(Capsule& s) const { return {'d', {&s.radius, &s.height}}; }
  Lengths operator()(Cone& s) const { return {'e', {&s.radius, &s.height}}; }
  Lengths operator()(BallHull& s) const {
    Lengths lengths{'f'};
    for (BallHull::Ball& ball : s.balls) {
      lengths.points.push_back(&ball.centre);
      for (double& semi_axis : ball.semi_axes) lengths.sizes.push_back(&semi_axis);
    }
    return lengths;
  }
  Lengths operator()(Hull& s) const { return {'g', {}, addressesOf(s.points)}; }
  Lengths operator()(TriangleSoup& s) const { return {'h', {}, addressesOf(s.corners)}; }
  template <class Other>
  Lengths operator()(Other&) const {
    AMBIENT_ASSERT(false && "no collision shape is read as this kind");
    return {};
  }
};

Lengths lengthsOf(PlacedShape& part) { return std::visit(LengthFinder{}, part.shape); }

/// Replaces each length, be it a size or the coordinate of a point.
template <class Size, class Coordinate>
void changeLengths(PlacedShape& part, const Size& size, const Coordinate& coordinate) {
  const Lengths lengths = lengthsOf(part);
  for (double* length : lengths.sizes) *length = size(*length);
  for (Eigen::Vector3d* point : lengths.points) *point = point->unaryExpr(coordinate);
  part.pose.translation() = part.pose.translation().unaryExpr(size).eval();
}

double rounded(double value, int digits) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, digits)), exponent - digits);
}

/// The largest size or place.
double largestNumber(PlacedShape part) {
  double largest = 0;
  bool is_finite = true;
  const auto take = [&](double length) {
    largest = std::max(largest, std::abs(length));
    is_finite = is_finite && std::isfinite(length);
    return length;
  };
  changeLengths(part, take, take);
  if (!is_finite) raiseInputError(part.name, "a size or a place in it is not finite");
  return largest;
}

void appendCount(std::string& bytes, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
}

void appendNumbers(std::string& bytes, const double* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const double value = values[i] + 0.0;  // -0 is 0
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
}

void append(std::string& bytes, const double* values, std::size_t count) {
  appendCount(bytes, count);
  appendNumbers(bytes, values, count);
}

}  // namespace

Matrix3 axesAlong(const Vector3& third) {
  int aside = 0;
  third.cwiseAbs().minCoeff(&aside);
  Matrix3 axes;
  axes.col(2) = third;
  axes.col(0) = third.cross(Vector3(Vector3::Unit(aside))).normalized();
  axes.col(1) = third.cross(Vector3(axes.col(0)));
  return axes;
}

PlacedShape scaled(PlacedShape part, double factor) {
  const auto scale = [&](double length) { return length * factor; };
  changeLengths(part, scale, scale);
  return part;
}

std::string contentOf(std::vector<PlacedShape> parts) {
  std::string bytes;
  for (PlacedShape& part : parts) {
    const Lengths lengths = lengthsOf(part);
    const Matrix3 rotation = part.pose.linear();
    const Vector3 translation = part.pose.translation();
    bytes += lengths.kind;
    appendCount(bytes, lengths.sizes.size());
    for (const double* size : lengths.sizes) appendNumbers(bytes, size, 1);
    appendCount(bytes, 3 * lengths.points.size());
    for (const Eigen::Vector3d* point : lengths.points) appendNumbers(bytes, point->data(), 3);
    append(bytes, rotation.data(), 9);
    append(bytes, translation.data(), 3);
  }
  return bytes;
}

void requireUsualNumbers(const std::vector<PlacedShape>& parts) {
  for (const PlacedShape& part : parts) {
    const double largest = largestNumber(part);
    if (largest == 0 || (largest >= kSmallestSize && largest <= kLargestSize)) continue;
    raiseInputError(part.name, "its largest size or place is ", largest, " m; must be ",
                    kSmallestSize, " m to ", kLargestSize, " m");
  }
}

ShapeForm normalised(ShapeForm form) {
  constexpr int kSizeDigits = 20, kPointDigits = 24;
  double largest = 0;
  for (const PlacedShape& part : form.parts) largest = std::max(largest, largestNumber(part));
  if (!(largest > 0)) raiseInputError(form.parts.front().name, "it has no size");
  for (PlacedShape& part : form.parts) {
    changeLengths(
        part, [&](double size) { return rounded(size / largest, kSizeDigits); },
        [&](double x) { return rounded(x / largest, kPointDigits); });
  }
  form.size *= largest;
  return form;
}

namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kSame =
    3e-4;  // of radius and height: Bullet rounds corners of hulls to 1e-4 of it

/// Returns the area of the polygon on a circle of radius 1 with corners at these angles; 0 if two
/// neighbours are more than a 24th of a turn apart.
double areaOnUnitCircle(std::vector<double> angles) {
  constexpr double kWidest = 1.001 * 2 * kPi / 24;
  if (angles.empty()) return 0;
  std::sort(angles.begin(), angles.end());
  angles.push_back(angles.front() + 2 * kPi);
  double area = 0;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    const double gap = angles[i] - angles[i - 1];
    if (gap > kWidest) return 0;
    area += portable::sin(gap) / 2;
  }
  return area;
}

/// The cylinder about an axis that is parallel to axis k.
std::optional<PlacedShape> cylinderAlong(int k, const Points& points) {
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  double low = points.front()[k], high = low, radius = 0;
  Eigen::Vector3d centre(0, 0, 0);
  for (const Eigen::Vector3d& point : points) {
    low = std::min(low, point[k]);
    high = std::max(high, point[k]);
    centre += point / static_cast<double>(points.size());
  }
  centre[k] = (low + high) / 2;
  const double half = (high - low) / 2;
  for (const Eigen::Vector3d& point : points)
    radius += portable::hypot(point[i] - centre[i], point[j] - centre[j]) /
              static_cast<double>(points.size());
  std::vector<double> angles[2];
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d r = point - centre;
    if (!(std::abs(std::abs(r[k]) - half) <= kSame * half)) return std::nullopt;
    if (!(std::abs(portable::hypot(r[i], r[j]) - radius) <= kSame * radius)) return std::nullopt;
    angles[r[k] > 0].push_back(portable::atan2(r[j], r[i]));
  }
  const double area = std::min(areaOnUnitCircle(angles[0]), areaOnUnitCircle(angles[1]));
  if (!(area > 0) || !(half > 0)) return std::nullopt;
  PlacedShape part{Cylinder{radius * std::sqrt(area / kPi), 2 * half}};
  part.pose.linear() << Eigen::Vector3d::Unit(i), Eigen::Vector3d::Unit(j),
      Eigen::Vector3d::Unit(k);
  part.pose.translation() = centre;
  return part;
}

}  // namespace

ShapeForm recognised(ShapeForm form) {
  if (form.parts.size() != 1) return form;
  PlacedShape& part = form.parts.front();
  const auto* hull = std::get_if<Hull>(&part.shape);
  if (!hull || hull->points.empty()) return form;
  for (int k = 0; k < 3; ++k) {
    const std::optional<PlacedShape> cylinder = cylinderAlong(k, hull->points);
    if (!cylinder) continue;
    part.pose = part.pose * cylinder->pose;
    part.shape = cylinder->shape;
    return form;
  }
  return form;
}

namespace {

constexpr int kImages = 8;

Vector3 signsOf(int turned) {
  return {turned & 1 ? -1.0 : 1.0, turned & 2 ? -1.0 : 1.0, turned & 4 ? -1.0 : 1.0};
}

/// Rounds to 24 binary digits after the point; without -0.
Vector3 rounded(const Vector3& v) {
  return v.unaryExpr([](double x) { return std::ldexp(std::round(std::ldexp(x, 24)), -24) + 0.0; });
}

/// A unit vector, rounded, the one of v and -v whose first number is positive.
Vector3 upward(const Vector3& v) {
  const Vector3 axis = rounded(v).normalized();
  for (const double x : axis)
    if (x != 0) return x < 0 ? Vector3(-axis + Vector3::Zero()) : axis;
  return axis;
}

/// Brings a part with mirrored axes into the pose that its surface alone decides; false: it has
/// none.
struct PoseMaker {
  const Matrix3 axes;
  RigidPose& pose;
  const Vector3 signs;

  bool operator()(Sphere&) const { return setAxes(Matrix3::Identity()); }
  bool operator()(Cylinder&) const { return setAxes(axesAlong(upward(axes.col(2)))); }
  bool operator()(Capsule&) const { return setAxes(axesAlong(upward(axes.col(2)))); }
  bool operator()(Cone&) const { return setAxes(axesAlong(rounded(axes.col(2)).normalized())); }
  bool operator()(Box&) const {
    Matrix3 turned;
    turned.col(0) = upward(axes.col(0));
    const Vector3 second = upward(axes.col(1));
    turned.col(1) = (second - second.dot(turned.col(0)) * turned.col(0)).normalized();
    turned.col(2) = turned.col(0).cross(turned.col(1));
    return setAxes(turned);
  }
  bool operator()(Hull& hull) const {
    for (Eigen::Vector3d& point : hull.points)
      point = rounded(signs.cwiseProduct(Vector3(pose * point)));
    std::sort(hull.points.begin(), hull.points.end(), [](const auto& a, const auto& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
    pose = RigidPose::Identity();
    return true;
  }
  template <class Other>
  bool operator()(Other&) const {
    return false;
  }

 private:
  bool setAxes(const Matrix3& turned) const {
    pose.linear() = turned;
    pose.translation() = rounded(signs.cwiseProduct(Vector3(pose.translation())));
    return true;
  }
};

/// The image, parts in poses of their own; false: a part has none.
bool turn(ShapeForm& form, int turned) {
  const Vector3 signs = signsOf(turned);
  return std::all_of(form.parts.begin(), form.parts.end(), [&](PlacedShape& part) {
    const Matrix3 axes = signs.asDiagonal() * Matrix3(part.pose.linear());
    return std::visit(PoseMaker{axes, part.pose, signs}, part.shape);
  });
}

void turn(std::vector<double>& column, double sign) {
  if (sign < 0)
    for (double& value : column) value = 0 - value;
}

void turn(FaceTable& faces, const Vector3& signs) {
  SharedList<double>* normals[] = {&faces.normal_x, &faces.normal_y, &faces.normal_z};
  std::vector<double>* places[] = {&faces.centroid_x, &faces.centroid_y, &faces.centroid_z};
  for (int axis = 0; axis < 3; ++axis) {
    if (signs[axis] > 0) continue;
    turn(normals[axis]->own(), signs[axis]);
    turn(*places[axis], signs[axis]);
  }
}

/// Triangles that are counter-clockwise again.
void reverse(SharedList<std::int32_t>& triangles) {
  std::vector<std::int32_t>& own = triangles.own();
  for (std::size_t t = 0; t + 2 < own.size(); t += 3) std::swap(own[t + 1], own[t + 2]);
}

Matrix6 turned(const Matrix6& inertia, const Vector3& signs) {
  Vector6 both;
  both << signs.prod() * signs, signs;  // a rotation is an axial vector
  return both.asDiagonal() * inertia * both.asDiagonal();
}

Matrix3 turned(const Matrix3& matrix, const Vector3& signs) {
  return signs.asDiagonal() * matrix * signs.asDiagonal();
}

void turn(FormShape& shape, const Vector3& signs) {
  for (Vector3* v : {&shape.facing, &shape.span, &shape.slender, &shape.pitching, &shape.centre})
    *v = v->cwiseProduct(signs);
}

/// Turns the axes of separation to an image; where a mirror makes them left-handed, the last one
/// points the other way.
void turn(Separation& separation, const Vector3& signs) {
  separation.axes = signs.asDiagonal() * separation.axes;
  if (signs.prod() > 0) return;
  separation.axes.col(2) *= -1;
  std::swap(separation.ways[4], separation.ways[5]);
}

void turn(ViscousForm& form, const Vector3& signs) {
  form.resistance = turned(form.resistance, signs);
  form.centre_of_reaction = form.centre_of_reaction.cwiseProduct(signs);
  form.surface.gyration = turned(form.surface.gyration, signs);
  turn(form.separation, signs);
}

}  // namespace

FormImage firstImage(const ShapeForm& form) {
  FormImage first{form, 0};
  std::string least;
  for (int axes = 0; axes < kImages; ++axes) {
    ShapeForm image = form;
    if (!turn(image, axes)) return {form, 0};
    std::string content = contentOf(image.parts);
    if (axes > 0 && !(content < least)) continue;
    least = std::move(content);
    first = {std::move(image), axes};
  }
  return first;
}

FluidBody imageOf(const FluidBody& body, int axes) {
  AMBIENT_ASSERT(body.holds.empty() && body.wings.empty() && body.waterline.empty() &&
                 body.drag.isZero(0) && axes >= 0 && axes < kImages);
  const Vector3 signs = signsOf(axes);
  FluidBody image = body;
  image.added_mass = turned(body.added_mass, signs);
  for (Vector3* place : {&image.centre_of_volume, &image.origin, &image.uniform_mass.centre,
                         &image.surface_mass.centre})
    *place = place->cwiseProduct(signs);
  for (MassDistribution* mass : {&image.uniform_mass, &image.surface_mass})
    mass->inertia = turned(mass->inertia, signs);
  turn(image.faces, signs);
  for (std::size_t i = 0; i < image.surface.vertices.size(); ++i)
    image.surface.vertices[i] *= signs[static_cast<int>(i % 3)];
  turn(image.form.shape, signs);
  turn(image.form.rest, signs);
  turn(image.form.faces, signs);
  if (signs.prod() < 0) {
    reverse(image.surface.triangles);
    reverse(image.form.hull);
  }
  turn(image.viscous, signs);
  for (FormLevel& level : image.form_levels) turn(level.faces, signs);
  std::vector<AddedMassPart> parts = body.added_mass_parts.all();
  for (AddedMassPart& part : parts) part = imageOf(part, axes);
  image.added_mass_parts = parts;
  image.provenance.settings += "; image " + std::to_string(axes);
  return image;
}

}  // namespace ambient
