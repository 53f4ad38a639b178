#include "preprocess/collision_shape/shape_part.h"

#include <algorithm>
#include <cmath>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/usual_size.h"

namespace ambient {
namespace {

constexpr int kSizeDigits = 20, kPointDigits = 24;

double rounded(double value, int digits) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, digits)), exponent - digits);
}

/// The largest size or place.
double largestNumber(const ShapePart& part) {
  double largest = std::max(std::abs(part.margin), part.translation.cwiseAbs().maxCoeff());
  bool is_finite = std::isfinite(part.margin) && part.translation.allFinite();
  for (const double size : part.sizes) {
    largest = std::max(largest, std::abs(size));
    is_finite = is_finite && std::isfinite(size);
  }
  for (const Eigen::Vector3d& point : part.points) {
    largest = std::max(largest, point.cwiseAbs().maxCoeff());
    is_finite = is_finite && point.allFinite();
  }
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

std::vector<ShapePart> scaled(std::vector<ShapePart> parts, double factor) {
  for (ShapePart& part : parts) {
    for (double& size : part.sizes) size *= factor;
    for (Eigen::Vector3d& point : part.points) point *= factor;
    part.margin *= factor;
    part.translation *= factor;
  }
  return parts;
}

std::string contentOf(const std::vector<ShapePart>& parts) {
  std::string bytes;
  for (const ShapePart& part : parts) {
    bytes += static_cast<char>('a' + static_cast<int>(part.kind));
    append(bytes, part.sizes.data(), part.sizes.size());
    appendCount(bytes, 3 * part.points.size());
    for (const Eigen::Vector3d& point : part.points) appendNumbers(bytes, point.data(), 3);
    append(bytes, &part.margin, 1);
    append(bytes, part.rotation.data(), 9);
    append(bytes, part.translation.data(), 3);
  }
  return bytes;
}

void requireUsualNumbers(const std::vector<ShapePart>& parts) {
  for (const ShapePart& part : parts) {
    const double largest = largestNumber(part);
    if (largest == 0 || (largest >= kSmallestSize && largest <= kLargestSize)) continue;
    raiseInputError(part.name, "its largest size or place is ", largest, " m; must be ",
                    kSmallestSize, " m to ", kLargestSize, " m");
  }
}

ShapeForm normalised(ShapeForm form) {
  double largest = 0;
  for (const ShapePart& part : form.parts) largest = std::max(largest, largestNumber(part));
  if (!(largest > 0)) raiseInputError(form.parts.front().name, "it has no size");
  for (ShapePart& part : form.parts) {
    for (double& size : part.sizes) size = rounded(size / largest, kSizeDigits);
    for (Eigen::Vector3d& point : part.points) {
      for (double& x : point) x = rounded(x / largest, kPointDigits);
    }
    part.margin = rounded(part.margin / largest, kSizeDigits);
    for (double& x : part.translation) x = rounded(x / largest, kSizeDigits);
  }
  form.size *= largest;
  return form;
}

}  // namespace ambient
