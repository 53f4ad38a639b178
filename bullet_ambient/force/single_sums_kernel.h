#pragma once

#include "bullet_ambient/force/single_lanes.h"
#include "bullet_ambient/force/single_sums.h"

// Included once by each single_sums_<instruction set>.cpp, which is compiled for that set.

namespace ambient {
namespace {

constexpr std::size_t kRun = 16;  ///< blocks that are summed in single precision
static_assert(FaceBlock::kFaces == kLanes, "a block has one face per lane");

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
