#include "bullet_ambient/force/single_sums_kernel.h"

namespace ambient {

LoadSums sumBlocksBaseline(const FaceBlocks& faces, const SingleMotion& motion) noexcept {
  return sumBlocks(faces, motion);
}

}  // namespace ambient
