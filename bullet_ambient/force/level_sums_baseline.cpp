#include "bullet_ambient/force/level_sums_kernel.h"

namespace ambient {

FaceSums sumClustersBaseline(const ClusterBlock* blocks, std::size_t count,
                             const SingleMotion& motion, bool with_friction) noexcept {
  return sumClusters(blocks, count, motion, with_friction);
}

}  // namespace ambient
