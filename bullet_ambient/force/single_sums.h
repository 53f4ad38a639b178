#pragma once

#include <cstddef>

#include "bullet_ambient/fluid_body/face_block.h"
#include "bullet_ambient/force/face_sums.h"

namespace ambient {

// The sums over faces in single precision. Plain data only, as in face_sums.h.

/// As FaceMotion. Lengths and times in units that make all components at most 1.
struct SingleMotion {
  float angular[3];
  float linear[3];
  float signed_cosine_sq;
  float sine_sq;
};

/// The sums of FaceSums over `count` blocks. Face i is summed into lane i mod 16, over 16 blocks in
/// single and over the rest in double precision. Which products are fused with their sums is
/// written out, and computed alike where a processor cannot fuse: all instruction sets give the
/// same bits.
using SumBlocks = FaceSums (*)(const FaceBlock* blocks, std::size_t count, const SingleMotion&,
                               bool with_friction) noexcept;

FaceSums sumBlocksBaseline(const FaceBlock*, std::size_t, const SingleMotion&, bool) noexcept;
#if defined(__x86_64__)
FaceSums sumBlocksAvx2(const FaceBlock*, std::size_t, const SingleMotion&, bool) noexcept;
FaceSums sumBlocksAvx512(const FaceBlock*, std::size_t, const SingleMotion&, bool) noexcept;
#endif

/// The kernel for an instruction set; null if this processor does not have it.
SumBlocks sumBlocksFor(InstructionSet instruction_set) noexcept;

}  // namespace ambient
