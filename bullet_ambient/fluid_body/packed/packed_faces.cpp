#include "bullet_ambient/fluid_body/packed/packed_faces.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/block_order.h"
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

PackedFaces::PackedFaces(const FaceTable& faces)
    : length_unit_(unitFor(std::max({largestOf(faces.centroid_x), largestOf(faces.centroid_y),
                                     largestOf(faces.centroid_z)}))),
      area_unit_(unitFor(largestOf(faces.area))) {
  order_ = orderOf(faces, length_unit_);
  AMBIENT_ASSERT(length_unit_ > 0 && area_unit_ > 0);
  const std::size_t count = (size() + FaceBlock::kFaces - 1) / FaceBlock::kFaces;
  blocks_.reserve(count);
  for (std::size_t block = 0; block < count; ++block) blocks_.push_back(packBlock(faces, block));
  bounds_.resize((count + FaceBounds::kBlocks - 1) / FaceBounds::kBlocks);  // all zero
  for (std::size_t block = 0; block < count; ++block) {
    setBounds(block);
    setPlace(block);
  }
}

PackedFaces::PackedFaces(const FaceTable& faces, const FormShape& shape) : PackedFaces(faces) {
  packForm(faces, shape);
}

FaceBlock PackedFaces::packBlock(const FaceTable& faces, std::size_t block) const {
  constexpr std::size_t kFaces = FaceBlock::kFaces;
  FaceBlock packed = {};
  for (std::size_t i = 0; i < std::min(kFaces, size() - block * kFaces); ++i) {
    const std::size_t face = order_[block * kFaces + i];
    const Vector3 normal = faces.normal(face);
    const Vector3 centroid = faces.centroid(face) / length_unit_;
    setColumn(packed.normal, i, normal);
    setColumn(packed.centroid, i, centroid);
    setColumn(packed.moment, i, centroid.cross(normal));
    packed.area[i] = static_cast<float>(faces.area[face] / area_unit_);
  }
  return packed;
}

void PackedFaces::packForm(const FaceTable& faces, const FormShape& shape) {
  AMBIENT_ASSERT(faces.sharpness.size() == size());
  form_.resize(blocks_.size());  // all zero
  lee_.resize(6 * 21);
  for (std::size_t i = 0; i < size(); ++i) {
    const std::size_t face = order_[i], at = i % FaceBlock::kFaces;
    const FormFactors<float> factors =
        formFactors<float>(static_cast<float>(faces.sharpness[face]));
    FormBlock& block = form_[i / FaceBlock::kFaces];
    block.by_normal[at] = factors.by_normal;
    block.by_speed[at] = factors.by_speed;
    block.by_lee[at] = factors.by_lee;
    addLee(faces, face, static_cast<double>(factors.by_lee));
    if (!shape.isWing()) continue;
    const double arm = shape.pitchingArm(faces.normal(face), faces.centroid(face));
    block.arm[at] = static_cast<float>(arm / length_unit_);
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
  constexpr std::size_t kFaces = FaceBlock::kFaces;
  // Rounding of a normal velocity in single precision; its terms are at most 1 and sqrt(3).
  constexpr float kRounding = 4e-6f;
  const FaceBlock& of = blocks_[block];
  const auto size = static_cast<std::ptrdiff_t>(std::min(kFaces, order_.size() - block * kFaces));
  FaceBounds& bounds = bounds_[block / FaceBounds::kBlocks];
  for (int row = 0; row < 6; ++row) {
    const float* values = row < 3 ? of.moment[row] : of.normal[row - 3];
    const auto [low, high] = std::minmax_element(values, values + size);
    bounds.middle[row][block % FaceBounds::kBlocks] = 0.5f * (*low + *high);
    bounds.reach[row][block % FaceBounds::kBlocks] = 0.5f * (*high - *low) + kRounding;
  }
}

void PackedFaces::setPlace(std::size_t block) {
  constexpr std::size_t kFaces = FaceBlock::kFaces;
  // Rounding of a depth in single precision, and the addition to the disc in eq. (59).
  constexpr float kRounding = 4e-6f;
  constexpr double kWider = 1 + 1e-4;
  const FaceBlock& of = blocks_[block];
  const auto size = static_cast<std::ptrdiff_t>(std::min(kFaces, order_.size() - block * kFaces));
  FaceBounds& bounds = bounds_[block / FaceBounds::kBlocks];
  const std::size_t lane = block % FaceBounds::kBlocks;
  for (int axis = 0; axis < 3; ++axis) {
    const float* values = of.centroid[axis];
    const auto [low, high] = std::minmax_element(values, values + size);
    bounds.centre[axis][lane] = 0.5f * (*low + *high);
    bounds.half[axis][lane] = 0.5f * (*high - *low) + kRounding;
  }
  const double largest = static_cast<double>(*std::max_element(of.area, of.area + size));
  const double radius = kWider * std::sqrt(largest * area_unit_ / kPi) / length_unit_;
  bounds.radius[lane] = static_cast<float>(radius) + kRounding;
}

}  // namespace ambient
