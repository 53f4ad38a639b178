#pragma once

#include <cstddef>

#include "bullet_ambient/fluid_body/face_block.h"
#include "bullet_ambient/spatial/instruction_set.h"

namespace ambient {

// The sums over faces in single precision. Plain data only, as in face_sums.h.

/// As FaceCut, in units of length.
struct SingleCut {
  float normal[3];
  float height;
  float disc;  ///< squared radius of a disc of unit area
};

/// As FaceMotion, with the skin friction. Lengths and times in units that make all components at
/// most 1.
struct SingleMotion {
  float angular[3];
  float linear[3];
  float signed_cosine_sq;
  float sine_sq;
  float friction;                  ///< C_f of a face that slips with the unit of speed; 0: none
  const SingleCut* cut = nullptr;  ///< null: all is in the fluid
};

/// Torque first: sum |t|^2 A (c x n, n) + friction |t|^0.8 A (c x t, t) over attached faces.
struct LoadSums {
  double wrench[6];
};

/// The sums over blocks, but for those whose bounds say that the flow is detached. Face i of a
/// block is summed into lane i, over 16 blocks in single and over the rest in double precision.
/// Which products are fused with their sums is written out, and computed alike where a processor
/// cannot fuse: all instruction sets give the same bits.
using SumBlocks = LoadSums (*)(const FaceBlocks&, const SingleMotion&) noexcept;

LoadSums sumBlocksBaseline(const FaceBlocks&, const SingleMotion&) noexcept;
LoadSums sumBlocksAvx2(const FaceBlocks&, const SingleMotion&) noexcept;
LoadSums sumBlocksAvx512(const FaceBlocks&, const SingleMotion&) noexcept;
constexpr Kernels<SumBlocks> kSumBlocks{sumBlocksBaseline, sumBlocksAvx2, sumBlocksAvx512};

}  // namespace ambient
