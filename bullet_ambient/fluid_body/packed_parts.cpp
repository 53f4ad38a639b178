#include "bullet_ambient/fluid_body/packed_parts.h"

namespace ambient {

PackedParts::PackedParts(const std::vector<AddedMassPart>& parts) {
  constexpr std::size_t kParts = PartBlock::kParts;
  blocks_.resize((parts.size() + kParts - 1) / kParts);  // all zero
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const AddedMassPart& part = parts[i];
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
