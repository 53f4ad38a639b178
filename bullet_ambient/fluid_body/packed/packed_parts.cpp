#include "bullet_ambient/fluid_body/packed/packed_parts.h"

#include <cstdint>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/fluid_body/packed/block_order.h"
#include "bullet_ambient/spatial/invariants.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {
namespace {

/// Neighbours in one half of a block: the water covers them together, see sumChange().
std::vector<std::uint32_t> orderByPlace(const std::vector<AddedMassPart>& parts) {
  std::vector<Vector6> places;
  places.reserve(parts.size());
  for (const AddedMassPart& part : parts) places.push_back(stack({0, 0, 0}, part.centre));
  return orderInBlocks(places, PartBlock::kParts / 2);
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
    for (int k = 0; k < 6; ++k) block.spread[k][lane] = part.spread[k];
    int entry = 0;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column)
        block.inertia[entry++][lane] = part.inertia(row, column);
    sum_ += part.inertia;
  }
}

}  // namespace ambient
