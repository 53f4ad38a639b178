#pragma once

#include <LinearMath/btVector3.h>

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

// Bullet's vectors with their padding, four numbers at a time. Products and sums per number are
// those of btVector3, and sums of three numbers are added up in its order: the same bits.

static_assert(sizeof(btVector3) == 4 * sizeof(btScalar));

/// For sources that compile a function once more for a larger instruction set.
#define AMBIENT_INLINE inline __attribute__((always_inline))
/// Before such a function: compiles it for processors with AVX.
#if defined(__x86_64__)
#define AMBIENT_AVX __attribute__((target("avx")))
#else
#define AMBIENT_AVX
#endif

/// Copies of a function declared AMBIENT_INLINE, for processors without AVX and with it.
template <auto kFunction, class = decltype(kFunction)>
struct CompiledTwice;
template <auto kFunction, class Result, class... Args>
struct CompiledTwice<kFunction, Result (*)(Args...)> {
  static Result baseline(Args... args) { return kFunction(args...); }
  AMBIENT_AVX static Result avx(Args... args) { return kFunction(args...); }

  static constexpr Kernels<Result (*)(Args...)> kKernels{&baseline, &avx, &avx};
};

/// Returns the copy for the processor's instruction set.
template <auto kFunction>
auto fastestCopy() noexcept {
  return CompiledTwice<kFunction>::kKernels.fastest();
}

#ifdef BT_USE_DOUBLE_PRECISION

/// Two vectors of two numbers, as every x86-64 processor has them.
struct Four {
  using Pair __attribute__((vector_size(16))) = double;
  Pair low, high;

  AMBIENT_INLINE double operator[](int i) const { return i < 2 ? low[i] : high[i - 2]; }
};
AMBIENT_INLINE Four operator*(const Four& a, const Four& b) {
  return {a.low * b.low, a.high * b.high};
}
AMBIENT_INLINE Four operator*(double s, const Four& a) { return {s * a.low, s * a.high}; }
AMBIENT_INLINE Four operator+(const Four& a, const Four& b) {
  return {a.low + b.low, a.high + b.high};
}

/// (ax + ay) + az and the same of b.
AMBIENT_INLINE Four::Pair sumsOfThree(const Four& a, const Four& b) {
  const Four::Pair x = __builtin_shufflevector(a.low, b.low, 0, 2);
  const Four::Pair y = __builtin_shufflevector(a.low, b.low, 1, 3);
  return (x + y) + __builtin_shufflevector(a.high, b.high, 0, 2);
}
/// Sums of the first three numbers of each: dot products of vectors whose products are given.
AMBIENT_INLINE Four sumsOfThree(const Four& a, const Four& b, const Four& c, const Four& d) {
  return {sumsOfThree(a, b), sumsOfThree(c, d)};
}

#else

using Four __attribute__((vector_size(16))) = float;

/// Sums of the first three numbers of each: dot products of vectors whose products are given.
AMBIENT_INLINE Four sumsOfThree(const Four& a, const Four& b, const Four& c, const Four& d) {
  const Four xy_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Four xy_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Four z_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four z_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  const Four x = __builtin_shufflevector(xy_ab, xy_cd, 0, 1, 4, 5);
  const Four y = __builtin_shufflevector(xy_ab, xy_cd, 2, 3, 6, 7);
  return (x + y) + __builtin_shufflevector(z_ab, z_cd, 0, 1, 4, 5);
}

#endif

/// Returns zeros that the compiler takes for any numbers. For known zeros GCC 12 moves two of four
/// numbers by an encoding that valgrind 3.19 does not know.
AMBIENT_INLINE Four anyZero() {
  Four zero{};
#if defined(__x86_64__) && !defined(BT_USE_DOUBLE_PRECISION)
  __asm__("" : "+x"(zero));
#endif
  return zero;
}

/// Two numbers in double: of a spin and of a velocity, say.
using DoublePair __attribute__((vector_size(16))) = double;
/// The pairs (a_i, b_i).
struct DoublePairs {
  DoublePair x, y, z;
};
/// a . c + b . d
AMBIENT_INLINE double product(const DoublePairs& ab, const DoublePairs& cd) {
  const DoublePair sums = (ab.x * cd.x + ab.y * cd.y) + ab.z * cd.z;
  return sums[0] + sums[1];
}
AMBIENT_INLINE DoublePairs pairsOf(const btVector3& a, const btVector3& b) {
  const auto pair = [&](int i) {
    return DoublePair{static_cast<double>(a.m_floats[i]), static_cast<double>(b.m_floats[i])};
  };
  return {pair(0), pair(1), pair(2)};
}

AMBIENT_INLINE Four load(const btVector3& v) {
  Four a;
  __builtin_memcpy(&a, v.m_floats, sizeof a);
  return a;
}
AMBIENT_INLINE void store(btVector3& v, const Four& a) {
  __builtin_memcpy(v.m_floats, &a, sizeof a);
}

AMBIENT_END
