#include "preprocess/potential_flow/positive_part.h"

#include <Eigen/Eigenvalues>

namespace ambient {

Matrix6 positivePart(const Matrix6& K) {
  const Matrix6 symmetric = (K + K.transpose()) / 2;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(symmetric);
  if (eigen.eigenvalues()[0] >= 0) return symmetric;
  const Matrix6 positive = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
                           eigen.eigenvectors().transpose();
  return (positive + positive.transpose()) / 2;
}

}  // namespace ambient
