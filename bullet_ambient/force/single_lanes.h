#pragma once

#include <cstdint>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "bullet_ambient/force/single_sums.h"

// What the kernels in single precision share: vectors of lanes, and their sums. Included by what is
// compiled once per instruction set. Written with the vector types of GCC and Clang, which have the
// +, -, *, > and ?: of IEEE 754 per lane.

#if defined(__FAST_MATH__)
#error "-ffast-math reorders the sums over faces; they must have the same bits everywhere"
#endif

namespace ambient {
namespace {

#if defined(__AVX512F__)
constexpr int kWidth = 16;
#elif defined(__AVX2__)
constexpr int kWidth = 8;
#else
constexpr int kWidth = 4;
#endif
constexpr int kLanes = 16;

using Floats = float __attribute__((vector_size(kWidth * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(kWidth * sizeof(std::int32_t))));

inline Floats load(const float* from) {
  Floats f;
  __builtin_memcpy(&f, from, sizeof f);
  return f;
}

inline void store(float* to, Floats f) { __builtin_memcpy(to, &f, sizeof f); }

#if defined(__AVX512F__)
inline Floats plusProduct(Floats c, Floats a, Floats b) { return _mm512_fmadd_ps(a, b, c); }
inline Floats lessProduct(Floats c, Floats a, Floats b) { return _mm512_fnmadd_ps(a, b, c); }
#elif defined(__AVX2__)
inline Floats plusProduct(Floats c, Floats a, Floats b) { return _mm256_fmadd_ps(a, b, c); }
inline Floats lessProduct(Floats c, Floats a, Floats b) { return _mm256_fnmadd_ps(a, b, c); }
#else
/// a b + c, rounded once.
inline float fused(float a, float b, float c) {
#if defined(__FP_FAST_FMAF)
  return __builtin_fmaf(a, b, c);
#else
  // In double the product is exact. Its sum with c is rounded to odd, which the second rounding,
  // to float, does not see (Boldo and Melquiond 2008).
  const double product = static_cast<double>(a) * static_cast<double>(b);
  const double addend = static_cast<double>(c);
  double sum = product + addend;
  const double part = sum - product;
  const double error = (product - (sum - part)) + (addend - part);  // of the sum, exact
  std::int64_t bits;
  __builtin_memcpy(&bits, &sum, sizeof bits);
  if (error != 0 && bits % 2 == 0) bits += (error > 0) == (sum > 0) ? 1 : -1;
  __builtin_memcpy(&sum, &bits, sizeof bits);
  return static_cast<float>(sum);
#endif
}

/// c + a b and c - a b, each rounded once. That halves the work on processors which have an
/// instruction for it, x86 since 2013, and takes thirty times as long on others.
inline Floats plusProduct(Floats c, Floats a, Floats b) {
  for (int lane = 0; lane < kWidth; ++lane) c[lane] = fused(a[lane], b[lane], c[lane]);
  return c;
}
inline Floats lessProduct(Floats c, Floats a, Floats b) { return plusProduct(c, -a, b); }
#endif

struct Vectors {
  Floats x, y, z;
};

inline Vectors load(const float (&columns)[3][kLanes], int lane) {
  return {load(columns[0] + lane), load(columns[1] + lane), load(columns[2] + lane)};
}
inline Vectors broadcast(const float v[3]) {
  return {Floats{} + v[0], Floats{} + v[1], Floats{} + v[2]};
}
inline Vectors operator+(Vectors a, Vectors b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vectors operator*(Floats s, Vectors a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vectors plusProduct(Vectors c, Floats s, Vectors a) {
  return {plusProduct(c.x, s, a.x), plusProduct(c.y, s, a.y), plusProduct(c.z, s, a.z)};
}
inline Vectors lessProduct(Vectors c, Floats s, Vectors a) {
  return {lessProduct(c.x, s, a.x), lessProduct(c.y, s, a.y), lessProduct(c.z, s, a.z)};
}
inline Floats dot(Vectors a, Vectors b) {
  return plusProduct(plusProduct(a.x * b.x, a.y, b.y), a.z, b.z);
}
/// c + a x b
inline Vectors plusCross(Vectors c, Vectors a, Vectors b) {
  return {lessProduct(plusProduct(c.x, a.y, b.z), a.z, b.y),
          lessProduct(plusProduct(c.y, a.z, b.x), a.x, b.z),
          lessProduct(plusProduct(c.z, a.x, b.y), a.y, b.x)};
}

/// Sums of a wrench over one run of blocks, one per lane.
struct WrenchLanes {
  float lanes[6][kLanes];

  void set(const Vectors& torque, const Vectors& force, int lane) {
    store(lanes[0] + lane, torque.x);
    store(lanes[1] + lane, torque.y);
    store(lanes[2] + lane, torque.z);
    store(lanes[3] + lane, force.x);
    store(lanes[4] + lane, force.y);
    store(lanes[5] + lane, force.z);
  }
};

/// x^(-3/5) of normal x > 0 to 3e-7; finite for 0.
inline Floats inverseThreeFifths(Floats x) {
  // The bit pattern is 2^23 times the logarithm to base 2 (plus 127), up to 0.09; see
  // fifth_root.h.
  constexpr float kOffset = 152.48f * 0x1p23f;
  Ints bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  const auto constant = [](float value) { return Floats{} + value; };
  const auto line = [&](float at_zero, float fall, Floats z) {
    return lessProduct(constant(at_zero), constant(fall), z);
  };
  bits = __builtin_convertvector(line(kOffset, 0.2f, __builtin_convertvector(bits, Floats)), Ints);
  Floats r;
  __builtin_memcpy(&r, &bits, sizeof r);
  const Floats square = r * r;
  const Floats cube = square * r;
  // x r^5 lies in [1.399, 1.885]; the minimax polynomial of its power -3/5 leaves 1.1e-7.
  const Floats z = plusProduct(constant(-1.625f), x * cube, square);
  const Floats z2 = z * z;
  const Floats high =
      plusProduct(line(0.135814669f, 0.0725031383f, z), z2, line(0.0412350679f, 0.0221427742f, z));
  return cube * plusProduct(line(0.747288029f, 0.275921004f, z), z2, high);
}

constexpr int kHalf = kWidth / 2;
using Doubles = double __attribute__((vector_size(kHalf * sizeof(double))));

inline Doubles load(const double* from) {
  Doubles d;
  __builtin_memcpy(&d, from, sizeof d);
  return d;
}

inline void store(double* to, Doubles d) { __builtin_memcpy(to, &d, sizeof d); }

/// Sums of a wrench over all runs, one per lane.
struct WrenchTotal {
  double lanes[6][kLanes];

  WrenchTotal() {
    for (double(&row)[kLanes] : lanes)
      for (int lane = 0; lane < kLanes; lane += kHalf) store(row + lane, Doubles{});
  }

  void add(const WrenchLanes& run) {
    for (int row = 0; row < 6; ++row)
      for (int lane = 0; lane < kLanes; ++lane)
        lanes[row][lane] += static_cast<double>(run.lanes[row][lane]);
  }

  LoadSums sum() const {
    LoadSums sums;
    for (int row = 0; row < 6; ++row) sums.wrench[row] = sumLanes(lanes[row]);
    return sums;
  }

 private:
  static double sumLanes(const double* row) {
    double folded[8];
    for (int lane = 0; lane < 8; lane += kHalf)
      store(folded + lane, load(row + lane) + load(row + lane + 8));
    const double* f = folded;
    return ((f[0] + f[4]) + (f[2] + f[6])) + ((f[1] + f[5]) + (f[3] + f[7]));
  }
};

}  // namespace
}  // namespace ambient
