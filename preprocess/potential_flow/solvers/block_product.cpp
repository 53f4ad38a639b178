#include "preprocess/potential_flow/solvers/block_product.h"

#include "bullet_ambient/base/instruction_set.h"
#include "preprocess/potential_flow/solvers/block_product_kernel.h"

namespace ambient {
namespace {

void addBlockProductBaseline(const MatrixBlock& block, const float* x, int fields, float* y) {
  return fields == kFieldGroup ? addAllRows<Floats4, 4, 2>(block, x, y)
                               : addAllRows<Floats4, 2, 6>(block, x, y);
}

auto fastestProduct() {
#if defined(__x86_64__)
  if (fastestInstructionSet() != InstructionSet::kBaseline) return addBlockProductAvx2;
#endif
  return addBlockProductBaseline;
}

}  // namespace

void addBlockProduct(const MatrixBlock& block, const float* x, int fields, float* y) {
  static const auto product = fastestProduct();
  product(block, x, fields, y);
}

}  // namespace ambient
