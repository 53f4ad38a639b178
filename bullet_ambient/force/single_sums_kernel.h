#pragma once

#include "bullet_ambient/force/single_lanes.h"
#include "bullet_ambient/force/single_sums.h"

// Included once by each single_sums_<instruction set>.cpp, which is compiled for that set.

namespace ambient {
namespace {

constexpr std::size_t kRun = 16;  ///< blocks that are summed in single precision
static_assert(FaceBlock::kFaces == kLanes, "a block has one face per lane");

/// docs/theory.md eq. (13) without a root, as in face_sums_kernel.h.
template <bool kRightAngle>
inline Floats strengthWhereAttached(Floats normal_speed, Floats strength, Floats speed_sq,
                                    const SingleMotion& motion) {
  const Floats zero = {};
  if (kRightAngle) return normal_speed > zero ? strength : zero;
  const Floats magnitude = normal_speed > zero ? normal_speed : -normal_speed;
  const Floats excess = plusProduct((normal_speed * magnitude) * motion.sine_sq, speed_sq,
                                    Floats{} + motion.signed_cosine_sq);
  return excess > zero ? strength : zero;
}

/// kWidth lanes of a run; docs/theory.md eq. (12) to (17).
template <bool kRightAngle, bool kFriction>
void sumRun(const FaceBlock* blocks, int count, const SingleMotion& motion, int lane,
            WrenchLanes& sums) {
  const Vectors w = broadcast(motion.angular);
  const Vectors v = broadcast(motion.linear);
  Vectors torque = {}, force = {};
  for (int k = 0; k < count; ++k) {
    const FaceBlock& block = blocks[k];
    const Vectors n = load(block.normal, lane);
    const Vectors c = load(block.centroid, lane);
    const Vectors u = plusCross(v, w, c);
    const Floats normal_speed = dot(n, u);
    const Vectors t = lessProduct(u, normal_speed, n);
    const Floats speed_sq = dot(t, t);
    const Floats strength = strengthWhereAttached<kRightAngle>(
        normal_speed, load(block.area + lane) * speed_sq, speed_sq, motion);
    if (kFriction) {
      const Floats along = (strength * motion.friction) * inverseThreeFifths(speed_sq);
      const Vectors f = plusProduct(strength * n, along, t);
      force = force + f;
      torque = plusCross(torque, c, f);
    } else {
      force = plusProduct(force, strength, n);
      torque = plusProduct(torque, strength, load(block.moment, lane));
    }
  }
  sums.set(torque, force, lane);
}

template <bool kRightAngle, bool kFriction>
LoadSums sumBlocks(const FaceBlock* blocks, std::size_t count, const SingleMotion& motion) {
  WrenchLanes run;
  WrenchTotal total;
  for (std::size_t begin = 0; begin < count; begin += kRun) {
    const int size = static_cast<int>(count - begin < kRun ? count - begin : kRun);
    for (int lane = 0; lane < kLanes; lane += kWidth)
      sumRun<kRightAngle, kFriction>(blocks + begin, size, motion, lane, run);
    total.add(run);
  }
  return total.sum();
}

LoadSums sumBlocks(const FaceBlock* blocks, std::size_t count, const SingleMotion& motion) {
  const bool friction = motion.friction > 0;
  if (motion.signed_cosine_sq == 0)
    return friction ? sumBlocks<true, true>(blocks, count, motion)
                    : sumBlocks<true, false>(blocks, count, motion);
  return friction ? sumBlocks<false, true>(blocks, count, motion)
                  : sumBlocks<false, false>(blocks, count, motion);
}

}  // namespace
}  // namespace ambient
