#include "bullet_ambient/force/single_sums_kernel.h"

namespace ambient {

LoadSums sumBlocksAvx512(const FaceBlock* blocks, std::size_t count,
                         const SingleMotion& motion) noexcept {
  return sumBlocks(blocks, count, motion);
}

}  // namespace ambient
