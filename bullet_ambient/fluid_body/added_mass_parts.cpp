#include "bullet_ambient/fluid_body/added_mass_parts.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/fluid_body/block_order.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

constexpr std::size_t kParts = PartBlock::kParts;

/// Neighbours in one half of a block: the water covers them together.
std::vector<std::uint32_t> orderByPlace(const std::vector<AddedMassPart>& parts) {
  std::vector<Vector6> places;
  places.reserve(parts.size());
  for (const AddedMassPart& part : parts)
    places.push_back(stack({0, 0, 0}, part.centre.allFinite() ? part.centre : Vector3::Zero()));
  return orderInBlocks(places, kParts / 2);
}

/// Returns the largest distance from the centre, along any direction, of the Gauss points of a part
/// [m]; a little more, against rounding.
double reachOf(const AddedMassPart& part) {
  constexpr double kNode = 9.0 / 5, kRounding = 1e-6;
  const Vector6& c = part.spread;
  Matrix3 spread;
  spread << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
  const double largest = symmetricEigen<3>(spread).values.maxCoeff();
  return (1 + kRounding) * std::sqrt(kNode * std::max(0.0, largest));
}

Matrix6 inertiaOf(const PartBlock& block, std::size_t lane) {
  Matrix6 inertia;
  int entry = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column)
      inertia(row, column) = inertia(column, row) =
          static_cast<double>(block.inertia[entry++][lane]);
  return inertia;
}

}  // namespace

AddedMassParts::AddedMassParts(const std::vector<AddedMassPart>& parts)
    : places_(parts.size()), blocks_((parts.size() + kParts - 1) / kParts) {  // all zero
  std::uint32_t place = 0;
  for (const std::uint32_t part : orderByPlace(parts)) places_[part] = place++;
  for (std::size_t i = 0; i < size(); ++i) {
    const AddedMassPart& part = parts[i];
    PartBlock& block = blocks_[places_[i] / kParts];
    const std::size_t lane = places_[i] % kParts;
    for (int axis = 0; axis < 3; ++axis)
      block.centre[axis][lane] = static_cast<float>(part.centre[axis]);
    block.reach[lane] = static_cast<float>(reachOf(part));
    for (int k = 0; k < 6; ++k) block.spread[k][lane] = static_cast<float>(part.spread[k]);
    int entry = 0;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        block.inertia[entry++][lane] = static_cast<float>(part.inertia(row, column));
  }
}

AddedMassPart AddedMassParts::operator[](std::size_t i) const {
  const PartBlock& block = blocks_[places_[i] / kParts];
  const std::size_t lane = places_[i] % kParts;
  AddedMassPart part;
  for (int axis = 0; axis < 3; ++axis)
    part.centre[axis] = static_cast<double>(block.centre[axis][lane]);
  for (int k = 0; k < 6; ++k) part.spread[k] = static_cast<double>(block.spread[k][lane]);
  part.inertia = inertiaOf(block, lane);
  return part;
}

std::vector<AddedMassPart> AddedMassParts::all() const {
  std::vector<AddedMassPart> parts;
  parts.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) parts.push_back((*this)[i]);
  return parts;
}

Matrix6 AddedMassParts::sum() const {
  Matrix6 sum = Matrix6::Zero();
  for (const PartBlock& block : blocks_)
    for (std::size_t lane = 0; lane < kParts; ++lane) sum += inertiaOf(block, lane);
  return sum;
}

AddedMassParts AddedMassParts::scaled(double factor) const {
  std::vector<AddedMassPart> parts = all();
  for (AddedMassPart& part : parts) {
    part.centre *= factor;
    part.spread *= factor * factor;
    part.inertia = scaleShape(part.inertia, factor);
  }
  return parts;
}

}  // namespace ambient
