#pragma once

#include <math.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/force/kernels/double_lanes.h"

// Functions of one number per body, side by side in the lanes of a register. For sources that are
// compiled once per instruction set, see force/kernels/double_lanes.h. No operation is fused and
// lanes are independent, so that every instruction set gives the same bits.

namespace ambient {
namespace {

using Lanes = Doubles;

inline Lanes all(double value) { return value - Lanes{}; }

inline Lanes squareRoot(const Lanes& a) {
#if defined(__AVX512F__)
  return _mm512_maskz_sqrt_pd(0xff, a);  // _mm512_sqrt_pd causes a warning in GCC 12's header
#elif defined(__AVX2__)
  return _mm256_sqrt_pd(a);
#elif defined(__x86_64__)
  return _mm_sqrt_pd(a);
#else
  Lanes root;
  for (int i = 0; i < kWidth; ++i) root[i] = ::sqrt(a[i]);
  return root;
#endif
}

/// Returns the larger number per lane; b where a is NaN.
inline Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

/// Returns c_0 + c_1 x + c_2 x^2 + ... per lane.
template <int kTerms>
Lanes polynomial(const double (&c)[kTerms], const Lanes& x) {
  Lanes sum = all(c[kTerms - 1]);
  for (int i = kTerms - 2; i >= 0; --i) sum = c[i] + x * sum;
  return sum;
}

/// Returns log(1 + z) / z per lane. @pre z >= 0
inline Lanes logarithmRatio(const Lanes& z) {
  // 2/(2 + z) artanh(s)/s, s = z/(2 + z); the series ends where the next term is below rounding.
  constexpr double kSmall = 0.1;
  static constexpr double kSeries[] = {1, 1.0 / 3, 1.0 / 5, 1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13};
  const Lanes scale = 1 / (2 + z);
  const Lanes s = z * scale;
  Lanes ratio = 2 * scale * polynomial(kSeries, s * s);
  if (!anyOf(!(z <= all(kSmall)))) return ratio;
  for (int i = 0; i < kWidth; ++i)
    if (!(z[i] <= kSmall)) ratio[i] = portable::log1p(z[i]) / z[i];
  return ratio;
}

/// Returns tan(x) per lane. @pre x >= 0
inline Lanes tangent(const Lanes& x) {
  constexpr double kSmall = 0.1;  // the first term left out is below rounding
  static constexpr double kSeries[] = {
      1.0,         1.0 / 3,         2.0 / 15,          17.0 / 315,
      62.0 / 2835, 1382.0 / 155925, 21844.0 / 6081075, 929569.0 / 638512875};
  Lanes t = x * polynomial(kSeries, x * x);
  if (!anyOf(!(x <= all(kSmall)))) return t;
  for (int i = 0; i < kWidth; ++i)
    if (!(x[i] <= kSmall)) t[i] = portable::tan(x[i]);
  return t;
}

}  // namespace
}  // namespace ambient
