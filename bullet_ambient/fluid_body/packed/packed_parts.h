#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/fluid_body/packed/part_block.h"

namespace ambient {

/// Parts of a shape's added mass, packed for kernels, in frame F: 248 bytes per part.
class PackedParts {
 public:
  explicit PackedParts(const std::vector<AddedMassPart>& parts);

  PartBlocks blocks() const { return {blocks_.data(), blocks_.size()}; }
  /// Sum of all parts: the added mass up to discretisation.
  const Matrix6& sum() const { return sum_; }

 private:
  std::vector<PartBlock> blocks_;
  Matrix6 sum_ = Matrix6::Zero();
};

}  // namespace ambient
