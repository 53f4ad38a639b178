#include "preprocess/base/numerics.h"

#include <Eigen/Core>

#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

Matrix6 positivePart(const Matrix6& K) {
  const Matrix6 symmetric = symmetricPart(K);
  const SymmetricEigen<6> eigen = symmetricEigen<6>(symmetric);
  if (eigen.values[0] >= 0) return symmetric;
  const Matrix6 positive =
      eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() * eigen.vectors.transpose();
  return symmetricPart(positive);
}

void fixBlocksOfLargeProducts() {
  // Eigen's sizes are written only once: other threads may be multiplying in later calls.
  [[maybe_unused]] static const bool is_done = [] {
    Eigen::setCpuCacheSizes(32 << 10, 1 << 20, 8 << 20);
    return true;
  }();
}

const GaussRule kGaussRules[GaussRule::kMost] = {
    {1, {0.5}, {1}},
    {2, {0.21132486540518712, 0.7886751345948129}, {0.5, 0.5}},
    {3,
     {0.1127016653792583, 0.5, 0.8872983346207417},
     {0.2777777777777778, 0.4444444444444444, 0.2777777777777778}},
    {4,
     {0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263},
     {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693}},
    {5,
     {0.04691007703066802, 0.23076534494715845, 0.5, 0.7692346550528415, 0.9530899229693319},
     {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
      0.11846344252809454}}};

}  // namespace ambient
