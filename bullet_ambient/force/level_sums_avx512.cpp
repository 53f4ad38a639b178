#include "bullet_ambient/force/level_sums_kernel.h"

namespace ambient {

LoadSums sumClustersAvx512(const LevelColumns& level, const double (&x)[6],
                           const SingleMotion& motion) noexcept {
  return sumClusters(level, x, motion);
}

}  // namespace ambient
