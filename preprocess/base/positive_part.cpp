#include "preprocess/base/positive_part.h"

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

}  // namespace ambient
