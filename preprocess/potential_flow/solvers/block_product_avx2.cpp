#include "preprocess/potential_flow/solvers/block_product.h"

namespace ambient {

void addBlockProductAvx2(const MatrixBlock& block, const float* x, int fields, float* y) {
  return fields == kFieldGroup ? addAllRows<Floats8, 8, 1>(block, x, y)
                               : addAllRows<Floats8, 4, 3>(block, x, y);
}

}  // namespace ambient
