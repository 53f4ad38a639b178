#pragma once

#include "bullet_ambient/base/lanes.h"
#include "bullet_ambient/force/law/skin_friction.h"

// Arithmetic of floats with products that are rounded once, for sources that are compiled once per
// instruction set, see lanes.h.

namespace ambient {

namespace {

constexpr int kLanes = 16;

#if defined(__AVX512F__)
inline Floats plusProduct(Floats c, Floats a, Floats b) { return _mm512_fmadd_ps(a, b, c); }
inline Floats lessProduct(Floats c, Floats a, Floats b) { return _mm512_fnmadd_ps(a, b, c); }
#elif defined(__AVX2__)
inline Floats plusProduct(Floats c, Floats a, Floats b) { return _mm256_fmadd_ps(a, b, c); }
inline Floats lessProduct(Floats c, Floats a, Floats b) { return _mm256_fnmadd_ps(a, b, c); }
#else
/// Returns a b + c, rounded once.
inline float fused(float a, float b, float c) {
#if defined(__FP_FAST_FMAF)
  return __builtin_fmaf(a, b, c);
#else
  // In double the product is exact. Its sum with c is rounded to odd, so that the second rounding,
  // to float, gives the fused result (Boldo and Melquiond 2008).
  const double product = static_cast<double>(a) * static_cast<double>(b);
  const double addend = static_cast<double>(c);
  double sum = product + addend;
  const double part = sum - product;
  const double error = (product - (sum - part)) + (addend - part);  // exact rounding error of sum
  std::int64_t bits;
  __builtin_memcpy(&bits, &sum, sizeof bits);
  if (error != 0 && bits % 2 == 0) bits += (error > 0) == (sum > 0) ? 1 : -1;
  __builtin_memcpy(&sum, &bits, sizeof bits);
  return static_cast<float>(sum);
#endif
}

/// Return c + a b and c - a b, rounded once. Processors without fused multiply-add (x86 before
/// 2013) emulate it, which takes about thirty times as long.
inline Floats plusProduct(Floats c, Floats a, Floats b) {
  for (int lane = 0; lane < kFloatWidth; ++lane) c[lane] = fused(a[lane], b[lane], c[lane]);
  return c;
}
inline Floats lessProduct(Floats c, Floats a, Floats b) { return plusProduct(c, -a, b); }
#endif

/// Returns x where it is positive, else 0.
#if defined(__AVX512F__)
inline Floats positivePart(Floats x) { return _mm512_maskz_max_ps(0xffff, x, Floats{}); }
#elif defined(__AVX2__)
inline Floats positivePart(Floats x) { return _mm256_max_ps(x, Floats{}); }
#else
inline Floats positivePart(Floats x) { return x > 0.0f ? x : Floats{}; }
#endif

/// Operations of PlainArithmetic (law/face_pressure.h), with sums of products rounded once.
struct FusedArithmetic {
  using Real = Floats;
  static Floats plus(Floats c, Floats a, Floats b) { return plusProduct(c, a, b); }
  static Floats less(Floats c, Floats a, Floats b) { return lessProduct(c, a, b); }
  static Floats positive(Floats x) { return positivePart(x); }
};

using Vectors = VectorsOf<Floats>;

inline Vectors plusProduct(Vectors c, Floats s, Vectors a) {
  return {plusProduct(c.x, s, a.x), plusProduct(c.y, s, a.y), plusProduct(c.z, s, a.z)};
}
inline Vectors lessProduct(Vectors c, Floats s, Vectors a) {
  return {lessProduct(c.x, s, a.x), lessProduct(c.y, s, a.y), lessProduct(c.z, s, a.z)};
}
inline Floats dot(const Vectors& a, const Vectors& b) {
  return plusProduct(plusProduct(a.x * b.x, a.y, b.y), a.z, b.z);
}
/// Returns c + a x b.
inline Vectors plusCross(Vectors c, Vectors a, Vectors b) {
  return {lessProduct(plusProduct(c.x, a.y, b.z), a.z, b.y),
          lessProduct(plusProduct(c.y, a.z, b.x), a.x, b.z),
          lessProduct(plusProduct(c.z, a.x, b.y), a.y, b.x)};
}

/// Returns |t|^-1.2 for |t|^2, the power in |t|^2 |t|^-1.2 = |t|^0.8.
inline Floats slipPower(Floats slip_sq) {
  return ambient::slipPower<Ints>(slip_sq, [](const Floats& c, const Floats& a, const Floats& b) {
    return plusProduct(c, a, b);
  });
}

}  // namespace

}  // namespace ambient
