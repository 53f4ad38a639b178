#include "bullet_ambient/fluid_body/packed/hull_symmetry.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

constexpr double kHullRounding = 1e-10;  // of the size

/// Vertices of a surface by their places, in steps of its rounding, and its triangles by them.
class Lattice {
 public:
  explicit Lattice(const Surface& surface) : surface_(surface) {
    double size = 0;
    for (const double x : surface.vertices) size = std::max(size, std::abs(x));
    const double inverse_step = size > 0 ? 1 / (kHullRounding * size) : 0;
    for (std::size_t i = 0; i + 2 < surface.vertices.size(); i += 3) {
      const double* x = &surface.vertices[i];
      places_.push_back({std::llround(x[0] * inverse_step), std::llround(x[1] * inverse_step),
                         std::llround(x[2] * inverse_step)});
      sorted_.emplace_back(places_.back(), static_cast<std::int32_t>(i / 3));
    }
    std::sort(sorted_.begin(), sorted_.end());
    const std::vector<std::int32_t> first = images({}, 0);  // of those at one place
    own_ = trianglesBy(first);
  }

  /// Returns true if the image of each triangle is one of them.
  bool maps(const HullSymmetry& symmetry, int image) const {
    const std::vector<std::int32_t> numbers = images(symmetry, image);
    return !numbers.empty() && trianglesBy(numbers) == own_;
  }

 private:
  using Place = std::array<std::int64_t, 3>;
  using Corners = std::array<std::int32_t, 3>;

  /// Numbers of the vertices at the places of the images of all; empty: one of them has none.
  std::vector<std::int32_t> images(const HullSymmetry& symmetry, int image) const {
    std::vector<std::int32_t> numbers;
    numbers.reserve(places_.size());
    for (const Place& place : places_) {
      const Place wanted = symmetry.imageOf(place, image);
      const auto found =
          std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(wanted, std::int32_t{0}));
      if (found == sorted_.end() || found->first != wanted) return {};
      numbers.push_back(found->second);
    }
    return numbers;
  }

  /// Corners of all triangles, each from its lowest number on, in order.
  std::vector<Corners> trianglesBy(const std::vector<std::int32_t>& numbers) const {
    std::vector<Corners> triangles;
    triangles.reserve(surface_.triangles.size() / 3);
    for (std::size_t i = 0; i + 2 < surface_.triangles.size(); i += 3) {
      const auto at = [&](std::size_t k) {
        return numbers[static_cast<std::size_t>(surface_.triangles[i + k])];
      };
      Corners corners{at(0), at(1), at(2)};
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      triangles.push_back(corners);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  }

  const Surface& surface_;
  std::vector<Place> places_;
  std::vector<std::pair<Place, std::int32_t>> sorted_;
  std::vector<Corners> own_;
};

bool isCut(const HullSymmetry& symmetry, int axis) {
  return symmetry.axis >= 0 && axis != symmetry.axis;
}

/// Returns the part of a convex polygon on the positive side of an axis; none of one on its plane.
std::vector<Vector3> partAlong(int axis, double rounding, std::vector<Vector3> polygon) {
  bool is_apart = false;
  for (Vector3& corner : polygon) {
    if (std::abs(corner[axis]) <= rounding) corner[axis] = 0;
    is_apart = is_apart || corner[axis] > 0;
  }
  std::vector<Vector3> part;
  for (std::size_t i = 0; is_apart && i < polygon.size(); ++i) {
    const Vector3 &here = polygon[i], &next = polygon[(i + 1) % polygon.size()];
    if (here[axis] >= 0) part.push_back(here);
    if (!(here[axis] * next[axis] < 0)) continue;
    part.push_back(here + here[axis] / (here[axis] - next[axis]) * (next - here));
    part.back()[axis] = 0;
  }
  return part;
}

template <class Places>
double roundingOf(const Places& places) {
  double size = 0;
  for (const Vector3& place : places) size = std::max(size, place.cwiseAbs().maxCoeff());
  return kHullRounding * size;
}

}  // namespace

HullSymmetry symmetryOf(const FluidBody& body) {
  constexpr std::size_t kFewTriangles = 48;
  const int mirrors = body.added_mass_parts.blocks().mirrors;
  if (body.form.hull.size() <= 3 * kFewTriangles || mirrors == 0) return {};
  const Lattice lattice(body.surface);
  for (int axis = 0; axis < 3; ++axis) {
    if ((mirrors | 1 << axis) == 7 && lattice.maps({axis}, 1)) return {axis};
  }
  return {};
}

std::vector<HullTriangle> partOf(const std::vector<HullTriangle>& triangles,
                                 const HullSymmetry& symmetry) {
  if (symmetry.axis < 0) return triangles;
  double rounding = 0;
  for (const HullTriangle& triangle : triangles)
    rounding = std::max(rounding, roundingOf(triangle));
  std::vector<HullTriangle> parts;
  for (const HullTriangle& triangle : triangles) {
    std::vector<Vector3> polygon(triangle.begin(), triangle.end());
    for (int axis = 0; axis < 3; ++axis)
      if (isCut(symmetry, axis)) polygon = partAlong(axis, rounding, std::move(polygon));
    for (std::size_t i = 2; i < polygon.size(); ++i)
      parts.push_back({polygon[0], polygon[i - 1], polygon[i]});
  }
  AMBIENT_ASSERT(!parts.empty());
  return parts;
}

std::vector<Vector3> partOf(const std::vector<Vector3>& corners, const HullSymmetry& symmetry) {
  const double rounding = roundingOf(corners);
  std::vector<Vector3> part;
  for (const Vector3& corner : corners) {
    bool is_kept = true;
    for (int axis = 0; axis < 3; ++axis)
      is_kept = is_kept && (!isCut(symmetry, axis) || corner[axis] >= -rounding);
    if (is_kept) part.push_back(corner);
  }
  return part;
}

}  // namespace ambient
