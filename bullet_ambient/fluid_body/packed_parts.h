#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/fluid_body/part_block.h"

namespace ambient {

/// The parts of a shape's added mass, for kernels, in frame F: 240 bytes each.
class PackedParts {
 public:
  explicit PackedParts(const std::vector<AddedMassPart>& parts);

  PartBlocks blocks() const { return {blocks_.data(), blocks_.size()}; }
  /// Of all parts: the added mass to the error of its discretisation.
  const Matrix6& sum() const { return sum_; }

 private:
  std::vector<PartBlock> blocks_;
  Matrix6 sum_ = Matrix6::Zero();
};

}  // namespace ambient
