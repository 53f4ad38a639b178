#pragma once

#include "bullet_ambient/force/single_lanes.h"

namespace ambient {
namespace {

/// Adds T(x, x), a quadratic form of the motion in each row: docs/theory.md eq. (36), and the lee
/// side by the form law. No operation is fused. `even`: 6 x 21, column by column, for the products
/// of the motion x_0 x_0, x_0 x_1 to x_5 x_5.
inline void addEvenPart(const double* even, const double (&x)[6], LoadSums& sums) {
  constexpr int kProducts = 21;
  double products[kProducts];
  for (int i = 0, next = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) products[next++] = x[i] * x[j];
  double part[8];
  for (int row = 0; row < 6; row += kHalf) {
    // A column has 6 rows. What is read beyond them is the next column: the
    // last one has none.
    Doubles a = {}, b = {};
    for (int k = 0; k < kProducts - 1; k += 2) {
      a = a + products[k] * load(even + 6 * k + row);
      b = b + products[k + 1] * load(even + 6 * k + 6 + row);
    }
    store(part + row, a + b);
  }
  const double* last = even + 6 * (kProducts - 1);
  for (int row = 0; row < 6; ++row)
    sums.wrench[row] += part[row] + products[kProducts - 1] * last[row];
}

}  // namespace
}  // namespace ambient
