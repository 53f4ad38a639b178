#include "preprocess/collision_shape/shape_form.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "bullet_ambient/base/ambient_assert.h"
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

}  // namespace ambient
