#include "bullet_ambient/fluid_body/packed/packed_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "bullet_ambient/fluid_body/form_factors.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

namespace {

double largestOf(const std::vector<double>& column) {
  double largest = 0;
  for (const double value : column) largest = std::max(largest, std::abs(value));
  return largest;
}

// Smallest power of two above a value; 1 for 0 and for values that are not finite.
double unitFor(double largest) {
  if (!(largest > 0) || !std::isfinite(largest)) return 1;
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, std::clamp(exponent, -1000, 1000));
}

void setColumn(float (&column)[3][FaceBlock::kFaces], std::size_t i, const Vector3& v) {
  for (int axis = 0; axis < 3; ++axis) column[axis][i] = static_cast<float>(v[axis]);
}

// Returns an order in which faces with similar normal and place are neighbours.
std::vector<std::uint32_t> orderOf(const FaceTable& faces, double length_unit) {
  std::vector<Vector6> coordinates;
  coordinates.reserve(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    coordinates.push_back(stack(faces.normal(i), faces.centroid(i) / length_unit));
  return orderInBlocks(coordinates, FaceBlock::kFaces);
}

}  // namespace

PackedFaces::PackedFaces(const FaceTable& faces, const FormShape* shape)
    : size_(faces.size()),
      length_unit_(unitFor(std::max({largestOf(faces.centroid_x), largestOf(faces.centroid_y),
                                     largestOf(faces.centroid_z)}))),
      area_unit_(unitFor(largestOf(faces.area))) {
  AMBIENT_ASSERT(length_unit_ > 0 && area_unit_ > 0);
  const Order order = orderOf(faces, length_unit_);
  const std::size_t count = (size() + FaceBlock::kFaces - 1) / FaceBlock::kFaces;
  const std::size_t groups = (count + FaceBoxes::kBlocks - 1) / FaceBoxes::kBlocks;
  const bool are_chosen = count >= FaceBlocks::kFewestChosen;
  blocks_.reserve(count);
  for (std::size_t block = 0; block < count; ++block)
    blocks_.push_back(packBlock(faces, order, block));
  boxes_.resize(groups);  // all zero
  if (are_chosen) bounds_.resize(groups);
  for (std::size_t block = 0; block < count; ++block) {
    setBox(block);
    if (are_chosen) setBounds(block);
  }
  if (shape) packForm(faces, order, *shape);
}

FaceBlock PackedFaces::packBlock(const FaceTable& faces, const Order& order,
                                 std::size_t block) const {
  FaceBlock packed = {};
  for (std::size_t i = 0; i < sizeOf(block); ++i) {
    const std::size_t face = order[block * FaceBlock::kFaces + i];
    const Vector3 normal = faces.normal(face);
    const Vector3 centroid = faces.centroid(face) / length_unit_;
    setColumn(packed.normal, i, normal);
    setColumn(packed.centroid, i, centroid);
    setColumn(packed.moment, i, centroid.cross(normal));
    packed.area[i] = static_cast<float>(faces.area[face] / area_unit_);
  }
  return packed;
}

std::size_t PackedFaces::sizeOf(std::size_t block) const {
  constexpr std::size_t kFaces = FaceBlock::kFaces;
  return std::min(kFaces, size() - block * kFaces);
}

void PackedFaces::packForm(const FaceTable& faces, const Order& order, const FormShape& shape) {
  AMBIENT_ASSERT(faces.sharpness.size() == size());
  sharpness_.resize(blocks_.size());  // all zero
  if (shape.isWing()) arms_.resize(blocks_.size());
  if (!bounds_.empty()) lee_.resize(6 * 21);
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t face = order[i], block = i / FaceBlock::kFaces, at = i % FaceBlock::kFaces;
    const auto sharpness = static_cast<float>(faces.sharpness[face]);
    sharpness_[block].of[at] = sharpness;
    if (!lee_.empty())
      addLee(faces, face, static_cast<double>(formFactors<float>(sharpness).by_lee));
    if (!shape.isWing()) continue;
    const double arm = shape.pitchingArm(faces.normal(face), faces.centroid(face));
    arms_[block].of[at] = static_cast<float>(arm / length_unit_);
  }
}

void PackedFaces::addLee(const FaceTable& faces, std::size_t face, double by_lee) {
  const Vector3 normal = faces.normal(face);
  const Vector6 m = stack(faces.centroid(face).cross(normal) / length_unit_, normal);
  const double strength = -by_lee * faces.area[face] / area_unit_;
  Eigen::Map<Eigen::Matrix<double, 6, 21>> lee(lee_.data());
  Eigen::Index column = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) lee.col(column++) += strength * (i == j ? 1 : 2) * m[i] * m[j] * m;
}

void PackedFaces::setBounds(std::size_t block) {
  // Rounding of a normal velocity in single precision; its terms are at most 1 and sqrt(3).
  constexpr float kRounding = 4e-6f;
  const FaceBlock& of = blocks_[block];
  const auto size = static_cast<std::ptrdiff_t>(sizeOf(block));
  FaceBounds& bounds = bounds_[block / FaceBounds::kBlocks];
  for (int row = 0; row < 6; ++row) {
    const float* values = row < 3 ? of.moment[row] : of.normal[row - 3];
    const auto [low, high] = std::minmax_element(values, values + size);
    bounds.middle[row][block % FaceBounds::kBlocks] = 0.5f * (*low + *high);
    bounds.reach[row][block % FaceBounds::kBlocks] = 0.5f * (*high - *low) + kRounding;
  }
}

void PackedFaces::setBox(std::size_t block) {
  // Rounding of a depth in single precision, and the addition to the disc in eq. (59).
  constexpr float kRounding = 4e-6f;
  constexpr double kWider = 1 + 1e-4;
  const FaceBlock& of = blocks_[block];
  const auto size = static_cast<std::ptrdiff_t>(sizeOf(block));
  FaceBoxes& boxes = boxes_[block / FaceBoxes::kBlocks];
  const std::size_t lane = block % FaceBoxes::kBlocks;
  for (int axis = 0; axis < 3; ++axis) {
    const float* values = of.centroid[axis];
    const auto [low, high] = std::minmax_element(values, values + size);
    boxes.centre[axis][lane] = 0.5f * (*low + *high);
    boxes.half[axis][lane] = 0.5f * (*high - *low) + kRounding;
  }
  const double largest = static_cast<double>(*std::max_element(of.area, of.area + size));
  const double radius = kWider * std::sqrt(largest * area_unit_ / kPi) / length_unit_;
  boxes.radius[lane] = static_cast<float>(radius) + kRounding;
}

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

/// Returns the symmetry by which a part of the hull of a body may be kept: but for rounding, the
/// image of each triangle of its surface is one of them. None of a hull of few triangles, nor of a
/// body whose added mass has no mirrors. Cost: O(T log T).
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

/// Returns what is kept: the parts of triangles on the positive side of the axes across that of the
/// symmetry. What rounding leaves beside their planes is on them.
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

/// Returns what is kept: the parts of triangles on the positive side of the axes across that of the
/// symmetry. What rounding leaves beside their planes is on them.
std::vector<HullTriangle> partOf(const std::vector<HullTriangle>& triangles,
                                 const HullSymmetry& symmetry);
/// Returns the corners that are kept.
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

std::vector<HullTriangle> trianglesOf(const Surface& surface,
                                      const std::vector<std::int32_t>& hull) {
  std::vector<HullTriangle> triangles;
  for (std::size_t i = 0; i < hull.size(); i += 3)
    triangles.push_back({vertexOf(surface, hull[i]), vertexOf(surface, hull[i + 1]),
                         vertexOf(surface, hull[i + 2])});
  return triangles;
}

// Returns the corners of all triangles without duplicates.
std::vector<Vector3> cornersOf(const std::vector<HullTriangle>& triangles) {
  std::vector<std::array<double, 3>> places;
  for (const HullTriangle& t : triangles)
    for (const Vector3& p : t) places.push_back({p.x(), p.y(), p.z()});
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::vector<Vector3> corners;
  for (const auto& p : places) corners.emplace_back(p[0], p[1], p[2]);
  return corners;
}

template <class Thing>
std::vector<Thing> inBlocks(const std::vector<Thing>& things, const std::vector<Vector3>& places,
                            std::size_t size) {
  std::vector<Thing> sorted;
  sorted.reserve(things.size());
  for (const std::uint32_t i : orderInBlocks(places, size)) sorted.push_back(things[i]);
  return sorted;
}

struct Box {
  Vector3 centre, half;
};

/// Axis-aligned box around points, enlarged against rounding.
Box boxAround(const Vector3* points, std::size_t count) {
  constexpr double kRounding = 1e-12;
  Vector3 low = points[0], high = points[0];
  for (std::size_t i = 1; i < count; ++i) {
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  const double size = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  return {(low + high) / 2, ((high - low) / 2).array() + kRounding * size};
}

Vector3 areaNormal(const HullTriangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]) / 2; }

/// Adds to N = sum A n, M = sum A n c^T, Q_jkl = sum int n_j z_k z_l dA; docs/theory.md eq. (57).
void add(const HullTriangle& t, HullMoments& moments) {
  const Vector3 normal = areaNormal(t);
  const Vector3 c = (t[0] + t[1] + t[2]) / 3;
  const Matrix3 second = (t[0] * t[0].transpose() + t[1] * t[1].transpose() +
                          t[2] * t[2].transpose() + 9 * c * c.transpose()) /
                         12;
  for (int j = 0; j < 3; ++j) {
    double* to = moments.of[j];
    *to++ += normal[j];
    for (int k = 0; k < 3; ++k) *to++ += normal[j] * c[k];
    for (int k = 0; k < 3; ++k)
      for (int l = k; l < 3; ++l) *to++ += normal[j] * second(k, l);
  }
}

HullBlock blockOf(const HullTriangle* triangles, std::size_t count) {
  AMBIENT_ASSERT(count > 0 && count <= HullBlock::kTriangles);
  HullBlock block = {};
  for (std::size_t i = 0; i < count; ++i)
    for (int axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 3; ++corner)
        block.corner[corner][axis][i] = triangles[i][static_cast<std::size_t>(corner)][axis];
  // Unused lanes repeat one corner of the last triangle: the block stays dry, cut or wet as it is.
  for (std::size_t i = count; i < HullBlock::kTriangles; ++i)
    for (auto& corner : block.corner)
      for (int axis = 0; axis < 3; ++axis) corner[axis][i] = triangles[count - 1][0][axis];
  return block;
}

HullWhole wholeOf(const std::vector<HullTriangle>& triangles) {
  HullWhole whole = {};
  const Box box = boxAround(triangles.front().data(), 3 * triangles.size());
  for (int axis = 0; axis < 3; ++axis) {
    whole.centre[axis] = box.centre[axis];
    whole.half[axis] = box.half[axis];
  }
  for (const HullTriangle& triangle : triangles) add(triangle, whole.moments);
  return whole;
}

double volumeOf(const std::vector<HullTriangle>& triangles) {
  double volume = 0;
  for (const HullTriangle& t : triangles) volume += t[0].dot(t[1].cross(t[2])) / 6;
  return volume;
}

}  // namespace

PackedHull::PackedHull(const FluidBody& body) {
  if (body.surface.triangles.empty()) return;
  requirePrepared(body);
  const std::vector<HullTriangle> triangles = trianglesOf(body.surface, body.form.hull);
  if (body.volume > 0) symmetry_ = symmetryOf(body);
  packPoints(partOf(cornersOf(triangles), symmetry_));
  if (!(body.volume > 0)) return;
  const double volume = volumeOf(triangles);
  if (volume > 0) volume_factor_ = body.volume / volume;
  AMBIENT_ASSERT(volume_factor_ > 0 && std::isfinite(volume_factor_));
  const std::vector<HullTriangle> part = partOf(triangles, symmetry_);
  if (symmetry_.axis >= 0) whole_ = std::make_shared<const HullWhole>(wholeOf(part));
  packTriangles(part);
}

PackedHull::PackedHull(const Surface& surface) {
  const std::vector<HullTriangle> triangles = trianglesOf(surface, surface.triangles);
  packPoints(cornersOf(triangles));
  packTriangles(triangles);
}

void PackedHull::packTriangles(const std::vector<HullTriangle>& unsorted) {
  constexpr std::size_t kTriangles = HullBlock::kTriangles, kBlocks = HullBoxes::kBlocks;
  std::vector<Vector3> places;
  for (const HullTriangle& t : unsorted) places.push_back(t[0] + t[1] + t[2]);
  const std::vector<HullTriangle> triangles = inBlocks(unsorted, places, kTriangles);
  const std::size_t count = (triangles.size() + kTriangles - 1) / kTriangles;
  blocks_.reserve(count);
  boxes_.resize((count + kBlocks - 1) / kBlocks);  // all zero
  moments_.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * kTriangles, size = std::min(kTriangles, triangles.size() - begin);
    blocks_.push_back(blockOf(&triangles[begin], size));
    const Box box = boxAround(triangles[begin].data(), 3 * size);
    for (int axis = 0; axis < 3; ++axis) {
      boxes_[k / kBlocks].centre[axis][k % kBlocks] = box.centre[axis];
      boxes_[k / kBlocks].half[axis][k % kBlocks] = box.half[axis];
    }
    for (std::size_t i = begin; i < begin + size; ++i) add(triangles[i], moments_[k]);
  }
}

void PackedHull::packPoints(const std::vector<Vector3>& points) {
  constexpr std::size_t kPoints = HullPoints::kPoints;
  const std::vector<Vector3> sorted = inBlocks(points, points, kPoints);
  points_.reserve((sorted.size() + kPoints - 1) / kPoints);
  for (std::size_t begin = 0; begin < sorted.size(); begin += kPoints) {
    const std::size_t count = std::min(kPoints, sorted.size() - begin);
    const Box box = boxAround(&sorted[begin], count);
    HullPoints& block = points_.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      block.centre[axis] = box.centre[axis];
      block.half[axis] = box.half[axis];
      for (std::size_t i = 0; i < kPoints; ++i)
        block.place[axis][i] = sorted[begin + std::min(i, count - 1)][axis];
    }
  }
}

}  // namespace ambient
