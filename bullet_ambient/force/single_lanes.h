#pragma once

#include <cstdint>

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
inline Vectors operator-(Vectors a, Vectors b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vectors operator*(Floats s, Vectors a) { return {s * a.x, s * a.y, s * a.z}; }
inline Floats dot(Vectors a, Vectors b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vectors cross(Vectors a, Vectors b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Sums of a wrench over one run of blocks, one per lane.
struct WrenchLanes {
  float lanes[6][kLanes];

  void set(Vectors torque, Vectors force, int lane) {
    const Floats rows[6] = {torque.x, torque.y, torque.z, force.x, force.y, force.z};
    for (int row = 0; row < 6; ++row) store(lanes[row] + lane, rows[row]);
  }
};

/// x^(-3/5) of normal x > 0 to 3e-7; finite for 0.
inline Floats inverseThreeFifths(Floats x) {
  // The bit pattern is 2^23 times the logarithm to base 2 (plus 127), up to 0.09; see
  // fifth_root.h.
  constexpr float kOffset = 152.48f * 0x1p23f;
  Ints bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  bits = __builtin_convertvector(kOffset - __builtin_convertvector(bits, Floats) * 0.2f, Ints);
  Floats r;
  __builtin_memcpy(&r, &bits, sizeof r);
  const Floats cube = r * r * r;
  // x r^5 lies in [1.399, 1.885]; the minimax polynomial of its power -3/5 leaves 1.1e-7.
  const Floats z = (x * cube) * (r * r) - 1.625f;
  const Floats z2 = z * z;
  return cube *
         ((0.747288029f - 0.275921004f * z) +
          z2 * ((0.135814669f - 0.0725031383f * z) + z2 * (0.0412350679f - 0.0221427742f * z)));
}

/// Sums of a wrench over all runs.
struct WrenchTotal {
  double lanes[6][kLanes] = {};

  void add(const WrenchLanes& run) {
    for (int row = 0; row < 6; ++row)
      for (int lane = 0; lane < kLanes; ++lane)
        lanes[row][lane] += static_cast<double>(run.lanes[row][lane]);
  }

  void sumLanes(double wrench[6]) {
    for (int width = kLanes / 2; width > 0; width /= 2)
      for (int row = 0; row < 6; ++row)
        for (int lane = 0; lane < width; ++lane) lanes[row][lane] += lanes[row][lane + width];
    for (int row = 0; row < 6; ++row) wrench[row] = lanes[row][0];
  }
};

}  // namespace
}  // namespace ambient
