#pragma once

#include "bullet_ambient/force/kernels/single_lanes.h"

namespace ambient {
namespace {

/// Adds the lee side of the form law to the wrench of `sums`: docs/theory.md eq. (43) for u_n <= 0,
/// summed over all faces, as the quadratic map of the twist x in eq. (36). `even`: 6 x 21
/// coefficients, column by column, for the products x_0 x_0, x_0 x_1 to x_5 x_5. No operation is
/// fused.
inline void addEvenPart(const double* even, const double (&x)[6], LoadSums& sums) {
  constexpr int kProducts = 21;
  double products[kProducts];
  for (int i = 0, next = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) products[next++] = x[i] * x[j];
  double part[8];
  for (int row = 0; row < 6; row += kHalf) {
    // With kHalf > 2, the load at the last rows also reads the start of the next column. The last
    // column has no next one, and is added below.
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
