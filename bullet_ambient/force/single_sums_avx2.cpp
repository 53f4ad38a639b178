#include "bullet_ambient/force/single_sums_kernel.h"

namespace ambient {

FaceSums sumBlocksAvx2(const FaceBlock* blocks, std::size_t count, const SingleMotion& motion,
                       bool with_friction) noexcept {
  return sumBlocks(blocks, count, motion, with_friction);
}

}  // namespace ambient
