#pragma once

// Registers of doubles for sources that are compiled once per instruction set. Everything is in an
// unnamed namespace, because these sources must share no inline function with the rest of the
// program. The vector types of GCC and Clang have the +, -, *, > and ?: of IEEE 754 per lane.

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "bullet_ambient/force/kernels/lane_vectors.h"

namespace ambient {
namespace {

#if defined(__AVX512F__)
constexpr int kWidth = 8;
#elif defined(__AVX2__)
constexpr int kWidth = 4;
#else
constexpr int kWidth = 2;
#endif

using Doubles = double __attribute__((vector_size(kWidth * sizeof(double))));

using Mask = decltype(Doubles{} < Doubles{});

/// True if a comparison holds in any lane.
inline bool anyOf(const Mask& mask) {
#if defined(__AVX512F__)
  return _mm512_movepi64_mask((__m512i)mask) != 0;
#elif defined(__AVX2__)
  return _mm256_movemask_pd((__m256d)mask) != 0;
#else
  decltype(mask[0] | mask[0]) any = 0;
  for (int i = 0; i < kWidth; ++i) any |= mask[i];
  return any != 0;
#endif
}

inline Doubles load(const double* from) {
  Doubles d;
  __builtin_memcpy(&d, from, sizeof d);
  return d;
}

inline void store(double* to, const Doubles& d) { __builtin_memcpy(to, &d, sizeof d); }

/// Sums eight lanes pairwise: ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)).
inline double sumLanes(const double (&lanes)[8]) {
  using Pair = double __attribute__((vector_size(16)));
  Pair pairs[4];
  __builtin_memcpy(pairs, lanes, sizeof pairs);
  const Pair sum = (pairs[0] + pairs[2]) + (pairs[1] + pairs[3]);
  return sum[0] + sum[1];
}

/// Square root per lane, correctly rounded with every instruction set.
#if defined(__AVX512F__)
inline Doubles root(const Doubles& x) { return _mm512_maskz_sqrt_pd(0xff, x); }
#elif defined(__AVX2__)
inline Doubles root(const Doubles& x) { return _mm256_sqrt_pd(x); }
#else
inline Doubles root(const Doubles& x) {
  return Doubles{__builtin_sqrt(x[0]), __builtin_sqrt(x[1])};
}
#endif

using Vectors = VectorsOf<Doubles>;

}  // namespace
}  // namespace ambient
