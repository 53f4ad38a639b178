#pragma once

#include "preprocess/potential_flow/solvers/flow_solver.h"

namespace ambient {

/// y += block x for 8 or 24 fields at once; x is columns x fields, y rows x fields, both row by
/// row. The same bits on every processor.
void addBlockProduct(const MatrixBlock& block, const float* x, int fields, float* y);

}  // namespace ambient
