#pragma once

// Registers of doubles and of floats for sources that are compiled once per instruction set.
// Everything is in an unnamed namespace, because these sources must share no inline function with
// the rest of the program. The vector types of GCC and Clang have the +, -, *, > and ?: of IEEE 754
// per lane.

#include <cstdint>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "bullet_ambient/base/lane_vectors.h"

namespace ambient {
namespace {

#if defined(__AVX512F__)
constexpr int kRegister = 64;  ///< size of a register in bytes
#elif defined(__AVX2__)
constexpr int kRegister = 32;
#else
constexpr int kRegister = 16;
#endif
constexpr int kWidth = kRegister / 8;  ///< number of doubles in a register
constexpr int kFloatWidth = kRegister / 4;

using Doubles = double __attribute__((vector_size(kRegister)));
using Floats = float __attribute__((vector_size(kRegister)));
using Ints = std::int32_t __attribute__((vector_size(kRegister)));
using Mask = decltype(Doubles{} < Doubles{});

/// True if a comparison holds in any lane.
template <class Comparison>
inline bool anyOf(const Comparison& mask) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#elif defined(__AVX2__)
  return _mm256_testz_si256((__m256i)mask, (__m256i)mask) == 0;
#else
  constexpr int kLanesOfMask = sizeof(mask) / sizeof(mask[0]);
  decltype(mask[0] | mask[0]) any = 0;
  for (int i = 0; i < kLanesOfMask; ++i) any |= mask[i];
  return any != 0;
#endif
}

inline Doubles load(const double* from) {
  Doubles d;
  __builtin_memcpy(&d, from, sizeof d);
  return d;
}
inline Floats load(const float* from) {
  Floats f;
  __builtin_memcpy(&f, from, sizeof f);
  return f;
}

/// Loads floats, as many as there are doubles in a register. GCC 12 converts vectors half by half.
inline Doubles loadDoubles(const float* from) {
#if defined(__AVX512F__)
  return _mm512_maskz_cvtps_pd(0xff, _mm256_loadu_ps(from));
#elif defined(__AVX2__)
  return _mm256_cvtps_pd(_mm_loadu_ps(from));
#else
  float __attribute__((vector_size(kRegister / 2))) f;
  __builtin_memcpy(&f, from, sizeof f);
  return __builtin_convertvector(f, Doubles);
#endif
}

inline void store(double* to, const Doubles& d) { __builtin_memcpy(to, &d, sizeof d); }
inline void store(float* to, const Floats& f) { __builtin_memcpy(to, &f, sizeof f); }

/// Loads 3-vectors from three columns.
template <class Number, int kColumn>
inline auto load(const Number (&columns)[3][kColumn], int lane) {
  return VectorsOf<decltype(load(columns[0]))>{load(columns[0] + lane), load(columns[1] + lane),
                                               load(columns[2] + lane)};
}

/// Sums eight lanes pairwise: ((0 + 4) + (2 + 6)) + ((1 + 5) + (3 + 7)).
inline double sumLanes(const double (&lanes)[8]) {
  using Pair = double __attribute__((vector_size(16)));
  Pair pairs[4];
  __builtin_memcpy(pairs, lanes, sizeof pairs);
  const Pair sum = (pairs[0] + pairs[2]) + (pairs[1] + pairs[3]);
  return sum[0] + sum[1];
}

/// Square roots per lane, correctly rounded with every instruction set.
#if defined(__AVX512F__)  // _mm512_sqrt_pd causes a warning in GCC 12's header
inline Doubles squareRoot(const Doubles& x) { return _mm512_maskz_sqrt_pd(0xff, x); }
inline Floats squareRoot(const Floats& x) { return _mm512_maskz_sqrt_ps(0xffff, x); }
#elif defined(__AVX2__)
inline Doubles squareRoot(const Doubles& x) { return _mm256_sqrt_pd(x); }
inline Floats squareRoot(const Floats& x) { return _mm256_sqrt_ps(x); }
#else
inline Doubles squareRoot(Doubles x) {
  for (int i = 0; i < kWidth; ++i) x[i] = __builtin_sqrt(x[i]);
  return x;
}
inline Floats squareRoot(Floats x) {
  for (int i = 0; i < kFloatWidth; ++i) x[i] = __builtin_sqrtf(x[i]);
  return x;
}
#endif

}  // namespace
}  // namespace ambient
