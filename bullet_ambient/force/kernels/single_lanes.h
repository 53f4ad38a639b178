#pragma once

#include "bullet_ambient/base/lanes.h"
#include "bullet_ambient/force/kernels/single_sums.h"
#include "bullet_ambient/force/law/skin_friction.h"

// Arithmetic of floats with products that are rounded once, and sums over lanes, for sources that
// are compiled once per instruction set, see lanes.h.

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

/// Partial sums over one run of blocks, one per lane: wrench, and pitch of LoadSums with wings.
struct WrenchLanes {
  float lanes[6][kLanes];
  float pitch[kLanes];

  // Inlined: else the vectors pass through memory.
  [[gnu::always_inline]] void set(const Vectors& torque, const Vectors& force, int lane) {
    store(lanes[0] + lane, torque.x);
    store(lanes[1] + lane, torque.y);
    store(lanes[2] + lane, torque.z);
    store(lanes[3] + lane, force.x);
    store(lanes[4] + lane, force.y);
    store(lanes[5] + lane, force.z);
  }
};

/// Returns |t|^-1.2 for |t|^2, the power in |t|^2 |t|^-1.2 = |t|^0.8.
inline Floats slipPower(Floats slip_sq) {
  return ambient::slipPower<Ints>(slip_sq, [](const Floats& c, const Floats& a, const Floats& b) {
    return plusProduct(c, a, b);
  });
}

/// Partial sums over all runs, one per lane: wrench, and with `kPitch` the pitch of LoadSums.
template <bool kPitch = false>
struct WrenchTotal {
  static constexpr int kRows = kPitch ? 7 : 6;
  double lanes[kRows][kLanes];

  WrenchTotal() {
    for (double(&row)[kLanes] : lanes)
      for (int lane = 0; lane < kLanes; lane += kWidth) store(row + lane, Doubles{});
  }

  void add(const WrenchLanes& run) {
    for (int row = 0; row < 6; ++row)
      for (int lane = 0; lane < kLanes; ++lane)
        lanes[row][lane] += static_cast<double>(run.lanes[row][lane]);
    if constexpr (kPitch)
      for (int lane = 0; lane < kLanes; ++lane)
        lanes[6][lane] += static_cast<double>(run.pitch[lane]);
  }

  LoadSums sum() const {
    LoadSums sums;
    for (int row = 0; row < 6; ++row) sums.wrench[row] = sumOf(lanes[row]);
    if constexpr (kPitch) sums.pitch = sumOf(lanes[6]);
    return sums;
  }

 private:
  static double sumOf(const double* row) {
    double folded[8];
    for (int lane = 0; lane < 8; lane += kWidth)
      store(folded + lane, load(row + lane) + load(row + lane + 8));
    return sumLanes(folded);
  }
};

/// Adds the lee side of the form law to the wrench of `sums`: docs/theory.md eq. (43) for u_n <= 0,
/// summed over all faces, as the quadratic map of the twist x in eq. (36). `even`: 6 x 21
/// coefficients, column by column, for the products x_0 x_0, x_0 x_1 to x_5 x_5. No operation is
/// fused.
inline void addQuadraticPart(const double* even, const double (&x)[6], LoadSums& sums) {
  constexpr int kProducts = 21;
  double products[kProducts];
  for (int i = 0, next = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) products[next++] = x[i] * x[j];
  double part[8];
  for (int row = 0; row < 6; row += kWidth) {
    // With kWidth > 2, the load at the last rows also reads the start of the next column. The last
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

/// Constants of the form law for lifting and slender shapes, the same in all lanes; zero if
/// motion.wing is null.
struct WingLanes {
  Vectors facing = {}, span = {}, slender = {};
  Floats pitching_rate = {}, stalling_share = {};

  // Inlined: else the vectors pass through memory.
  [[gnu::always_inline]] explicit WingLanes(const SingleMotion& motion) {
    if (!motion.wing) return;
    facing = inAllLanes<Floats>(motion.wing->facing);
    span = inAllLanes<Floats>(motion.wing->span);
    slender = inAllLanes<Floats>(motion.wing->slender);
    pitching_rate = pitching_rate + motion.pitching_rate;
    stalling_share = stalling_share + motion.stalling_share;
  }
};

}  // namespace

}  // namespace ambient
