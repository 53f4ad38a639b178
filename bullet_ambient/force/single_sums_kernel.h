#pragma once

#include <cstdint>

#include "bullet_ambient/force/single_sums.h"

// Included once by each single_sums_<instruction set>.cpp, which is compiled for that set. Written
// with the vector types of GCC and Clang, which have the +, -, *, > and ?: of IEEE 754 per lane.

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
constexpr int kLanes = FaceBlock::kFaces;
constexpr std::size_t kRun = 16;  ///< blocks that are summed in single precision

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

/// What the friction of a run needs from its pressure.
struct RunSlip {
  Floats t_x[kRun], t_y[kRun], t_z[kRun];  ///< -u_s
  Floats speed_sq[kRun];                   ///< |u_s|^2
  Floats strength[kRun];                   ///< |u_s|^2 A, or 0 where the flow is detached
};

/// docs/theory.md eq. (13) without a root, as in face_sums_kernel.h.
template <bool kRightAngle>
inline Floats strengthWhereAttached(Floats normal_speed, Floats strength, Floats speed_sq,
                                    const SingleMotion& motion) {
  const Floats zero = {};
  if (kRightAngle) return normal_speed > zero ? strength : zero;
  const Floats magnitude = normal_speed > zero ? normal_speed : -normal_speed;
  const Floats excess =
      (normal_speed * magnitude) * motion.sine_sq + speed_sq * motion.signed_cosine_sq;
  return excess > zero ? strength : zero;
}

/// kWidth lanes of a run; docs/theory.md eq. (12) to (15).
template <bool kRightAngle, bool kKeepSlip>
void sumPressure(const FaceBlock* blocks, int count, const SingleMotion& motion, int lane,
                 WrenchLanes& sums, RunSlip& slip) {
  const Vectors w = broadcast(motion.angular);
  const Vectors v = broadcast(motion.linear);
  Vectors torque = {}, force = {};
  for (int k = 0; k < count; ++k) {
    const FaceBlock& block = blocks[k];
    const Vectors n = load(block.normal, lane);
    const Vectors u = v + cross(w, load(block.centroid, lane));
    const Floats normal_speed = dot(n, u);
    const Vectors t = u - normal_speed * n;
    const Floats speed_sq = dot(t, t);
    const Floats strength = strengthWhereAttached<kRightAngle>(
        normal_speed, load(block.area + lane) * speed_sq, speed_sq, motion);
    force = force + strength * n;
    torque = torque + strength * load(block.moment, lane);
    if (kKeepSlip) {
      slip.t_x[k] = t.x;
      slip.t_y[k] = t.y;
      slip.t_z[k] = t.z;
      slip.speed_sq[k] = speed_sq;
      slip.strength[k] = strength;
    }
  }
  sums.set(torque, force, lane);
}

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

/// The friction of the same faces; docs/theory.md eq. (16) and (17).
void sumFriction(const FaceBlock* blocks, int count, int lane, WrenchLanes& sums, RunSlip& slip) {
  for (int k = 0; k < count; ++k)
    slip.strength[k] = slip.strength[k] * inverseThreeFifths(slip.speed_sq[k]);
  Vectors torque = {}, force = {};
  for (int k = 0; k < count; ++k) {
    const Vectors f = slip.strength[k] * Vectors{slip.t_x[k], slip.t_y[k], slip.t_z[k]};
    force = force + f;
    torque = torque + cross(load(blocks[k].centroid, lane), f);
  }
  sums.set(torque, force, lane);
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

template <bool kRightAngle, bool kFriction>
FaceSums sumBlocks(const FaceBlock* blocks, std::size_t count, const SingleMotion& motion) {
  RunSlip slip;
  WrenchLanes pressure_run, friction_run;
  WrenchTotal pressure, friction;
  for (std::size_t begin = 0; begin < count; begin += kRun) {
    const int size = static_cast<int>(count - begin < kRun ? count - begin : kRun);
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      sumPressure<kRightAngle, kFriction>(blocks + begin, size, motion, lane, pressure_run, slip);
      if (kFriction) sumFriction(blocks + begin, size, lane, friction_run, slip);
    }
    pressure.add(pressure_run);
    if (kFriction) friction.add(friction_run);
  }
  FaceSums sums = {};
  pressure.sumLanes(sums.pressure);
  if (kFriction) friction.sumLanes(sums.friction);
  return sums;
}

FaceSums sumBlocks(const FaceBlock* blocks, std::size_t count, const SingleMotion& motion,
                   bool with_friction) {
  if (motion.signed_cosine_sq == 0)
    return with_friction ? sumBlocks<true, true>(blocks, count, motion)
                         : sumBlocks<true, false>(blocks, count, motion);
  return with_friction ? sumBlocks<false, true>(blocks, count, motion)
                       : sumBlocks<false, false>(blocks, count, motion);
}

}  // namespace
}  // namespace ambient
