#include "preprocess/base/matrices.h"

#include <Eigen/Core>

#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

Matrix6 positivePart(const Matrix6& K) {
  const Matrix6 symmetric = (K + K.transpose()) / 2;
  const SymmetricEigen<6> eigen = symmetricEigen<6>(symmetric);
  if (eigen.values[0] >= 0) return symmetric;
  const Matrix6 positive =
      eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() * eigen.vectors.transpose();
  return (positive + positive.transpose()) / 2;
}

void fixBlocksOfLargeProducts() {
  // Eigen's sizes are written only once: other threads may be multiplying in later calls.
  [[maybe_unused]] static const bool is_done = [] {
    Eigen::setCpuCacheSizes(32 << 10, 1 << 20, 8 << 20);
    return true;
  }();
}

}  // namespace ambient
