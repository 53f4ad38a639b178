#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/fluid_body/blocks.h"
#include "bullet_ambient/force/kernels/load_sums.h"

namespace ambient {

// Sums over faces in single precision. Plain data only: the kernels are compiled once per
// instruction set, and must not share an inline function with the rest of the program.

/// Sums all blocks. Skips blocks without load: bounds show that the flow is detached from all their
/// faces. Face i of a block goes to lane i. Runs of 16 blocks are summed in single precision, and
/// runs are added in double. Fused products are explicit, and emulated on processors without them,
/// so that all instruction sets give the same bits.
using SumBlocks = LoadSums (*)(const FaceBlocks&, const SingleMotion&) noexcept;

LoadSums sumBlocksBaseline(const FaceBlocks&, const SingleMotion&) noexcept;
LoadSums sumBlocksAvx2(const FaceBlocks&, const SingleMotion&) noexcept;
LoadSums sumBlocksAvx512(const FaceBlocks&, const SingleMotion&) noexcept;
extern const Kernels<SumBlocks> kSumBlocks;

}  // namespace ambient
