#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// For sources that are compiled once per instruction set, see lanes.h.

namespace ambient {
namespace {

/// Factors L D L^T of symmetric 6x6 matrices K, one per lane.
class PositiveFactor {
 public:
  explicit PositiveFactor(const FullMatrices& K) {
    const Lanes one = all(1), zero = Lanes{};
    Lanes scaled[6];  // a row of L D
    for (int i = 0; i < 6; ++i) {
      Lanes pivot = K.entry(i, i);
      for (int j = 0; j < i; ++j) {
        scaled[j] = K.entry(i, j);
        for (int k = 0; k < j; ++k) scaled[j] = scaled[j] - scaled[k] * lower_[j][k];
        lower_[i][j] = scaled[j] * per_pivot_[j];
        pivot = pivot - scaled[j] * lower_[i][j];
      }
      const Mask is_fine = pivot > zero;
      is_positive_ = i == 0 ? is_fine : is_positive_ & is_fine;
      per_pivot_[i] = one / (is_fine ? pivot : one);
    }
  }

  /// Returns the lanes whose matrix is positive definite. Results in other lanes are undefined.
  Mask isPositive() const { return is_positive_; }

  /// Returns K^-1 b.
  Spatials solve(const Spatials& b) const {
    Lanes x[6] = {b.angular.x, b.angular.y, b.angular.z, b.linear.x, b.linear.y, b.linear.z};
    for (int i = 1; i < 6; ++i)
      for (int j = 0; j < i; ++j) x[i] = x[i] - lower_[i][j] * x[j];
    for (int i = 5; i >= 0; --i) {
      x[i] = x[i] * per_pivot_[i];
      for (int j = i + 1; j < 6; ++j) x[i] = x[i] - lower_[j][i] * x[j];
    }
    return {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  }

  /// Returns K^-1.
  FullMatrices inverse() const {
    Lanes M[6][6];  // L^-1 below its diagonal of ones
    for (int j = 0; j < 6; ++j)
      for (int i = j + 1; i < 6; ++i) {
        Lanes sum = lower_[i][j];
        for (int k = j + 1; k < i; ++k) sum = sum + lower_[i][k] * M[k][j];
        M[i][j] = -sum;
      }
    FullMatrices inverse;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i <= j; ++i) {
        Lanes sum = i == j ? per_pivot_[j] : M[j][i] * per_pivot_[j];
        for (int k = j + 1; k < 6; ++k) sum = sum + M[k][i] * M[k][j] * per_pivot_[k];
        inverse.entry(i, j) = sum;
      }
    return inverse;
  }

 private:
  Lanes lower_[6][6];  // L below its diagonal of ones
  Lanes per_pivot_[6];
  Mask is_positive_;
};

}  // namespace
}  // namespace ambient
