#include "bullet_ambient/fluid_body/packed/packed_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/fluid_body/packed/block_order.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/spatial_vectors.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

/// Neighbours in one half of a block: the water covers them together.
std::vector<std::uint32_t> orderByPlace(const std::vector<AddedMassPart>& parts) {
  std::vector<Vector6> places;
  places.reserve(parts.size());
  for (const AddedMassPart& part : parts) places.push_back(stack({0, 0, 0}, part.centre));
  return orderInBlocks(places, PartBlock::kParts / 2);
}

/// Returns the largest distance from the centre, along any direction, of the Gauss points of a part
/// [m]; a little more, against rounding.
double reachOf(const AddedMassPart& part) {
  constexpr double kNode = 9.0 / 5, kRounding = 1e-9;
  const Vector6& c = part.spread;
  Matrix3 spread;
  spread << c[0], c[3], c[4], c[3], c[1], c[5], c[4], c[5], c[2];
  const double largest = symmetricEigen<3>(spread).values.maxCoeff();
  return (1 + kRounding) * std::sqrt(kNode * std::max(0.0, largest));
}

}  // namespace

PackedParts::PackedParts(const std::vector<AddedMassPart>& parts) {
  const std::vector<std::uint32_t> order = orderByPlace(parts);
  constexpr std::size_t kParts = PartBlock::kParts;
  blocks_.resize((parts.size() + kParts - 1) / kParts);  // all zero
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const AddedMassPart& part = parts[order[i]];
    AMBIENT_ASSERT(isSymmetric(part.inertia, 1e-6));
    PartBlock& block = blocks_[i / kParts];
    const std::size_t lane = i % kParts;
    for (int axis = 0; axis < 3; ++axis) block.centre[axis][lane] = part.centre[axis];
    block.reach[lane] = reachOf(part);
    for (int k = 0; k < 6; ++k) block.spread[k][lane] = part.spread[k];
    int entry = 0;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        block.inertia[entry++][lane] = part.inertia(row, column);
    sum_ += part.inertia;
  }
}

}  // namespace ambient
