#pragma once

#include "bullet_ambient/force/level_sums.h"
#include "bullet_ambient/force/single_lanes.h"

// Included once by each level_sums_<instruction set>.cpp, which is compiled for that set.

namespace ambient {
namespace {

static_assert(ClusterBlock::kClusters == kLanes, "a block has one cluster per lane");

/// 1 / sqrt(x) of normal x > 0 to 2e-7, without a division.
inline Floats inverseRoot(Floats x) {
  Ints bits;
  __builtin_memcpy(&bits, &x, sizeof bits);
  bits = 0x5f375a86 - (bits >> 1);  // Lomont 2003
  Floats r;
  __builtin_memcpy(&r, &bits, sizeof r);
  const Floats half = 0.5f * x;
  for (int newton = 0; newton < 3; ++newton) r = r * (1.5f - half * r * r);
  return r;
}

struct Sixes {
  Vectors torque, force;
};

inline Sixes load(const float (&rows)[6][kLanes], int lane) {
  return {{load(rows[0] + lane), load(rows[1] + lane), load(rows[2] + lane)},
          {load(rows[3] + lane), load(rows[4] + lane), load(rows[5] + lane)}};
}

inline Floats dot(const Sixes& a, const Vectors& w, const Vectors& v) {
  return dot(a.torque, w) + dot(a.force, v);
}

/// Attached part of a cluster less one half: of a disc at the distance z of the terminator from its
/// centre, in radii; eq. (41).
inline Floats attachedExcess(Floats a, Floats spread_sq) {
  Floats z = (0.5f * a) * inverseRoot(spread_sq);
  z = z > 1.0f ? Floats{} + 1.0f : z;
  z = z < -1.0f ? Floats{} - 1.0f : z;
  return z * (0.63661977f - 0.13661977f * (z * z));
}

/// By how much the normal velocity may be negative where the flow is attached, eq. (13).
inline Floats reach(float cosine, Vectors u) {
  constexpr float kLeastSquare = 1e-30f;  // keeps the root of a cluster at rest finite
  const Floats u_sq = dot(u, u) + kLeastSquare;
  return cosine * (u_sq * inverseRoot(u_sq));
}

template <bool kRightAngle, bool kFriction>
void sumLane(const ClusterBlock* blocks, std::size_t count, const SingleMotion& motion, int lane,
             WrenchLanes& pressure_sums, WrenchLanes& friction_sums) {
  // Of a motion whose components are at most 1: keeps the switch of a flat cluster finite.
  constexpr float kLeastSpread = 1e-14f;
  const Vectors w = broadcast(motion.angular);
  const Vectors v = broadcast(motion.linear);
  const float cosine = __builtin_sqrtf(motion.signed_cosine_sq);  // |cos(alpha)|
  Vectors torque = {}, force = {}, friction_torque = {}, friction_force = {};
  for (std::size_t i = 0; i < count; ++i) {
    const ClusterBlock& block = blocks[i];
    const Sixes g = load(block.switching, lane);
    const Floats a = dot(g, w, v);
    const Floats b1 = dot(load(block.spread[0], lane), w, v);
    const Floats b2 = dot(load(block.spread[1], lane), w, v);
    const Floats spread_sq = b1 * b1 + b2 * b2 + kLeastSpread;
    const Vectors c = load(block.centroid, lane);
    const Vectors u = plusCross(v, w, c);
    const Floats excess = attachedExcess(kRightAngle ? a : a + reach(cosine, u), spread_sq);
    const Vectors t = lessProduct(u, dot(g.force, u), g.force);
    const Floats slip_sq = dot(t, t);
    const Floats part = kRightAngle ? excess : excess - 0.5f;
    const Floats by_slip = part * slip_sq;
    const Floats by_normal = part * (a * a + spread_sq);
    const Sixes slip = load(block.by_slip, lane);
    const Sixes normal = load(block.by_normal, lane);
    torque = torque + (by_slip * slip.torque + by_normal * normal.torque);
    force = force + (by_slip * slip.force + by_normal * normal.force);
    if (kFriction) {
      const Floats area = load(block.area + lane) * (0.5f + excess);
      const Vectors f = ((area * slip_sq) * inverseThreeFifths(slip_sq)) * t;
      friction_force = friction_force + f;
      friction_torque = plusCross(friction_torque, c, f);
    }
  }
  pressure_sums.set(torque, force, lane);
  if (kFriction) friction_sums.set(friction_torque, friction_force, lane);
}

template <bool kRightAngle, bool kFriction>
FaceSums sumClusters(const ClusterBlock* blocks, std::size_t count, const SingleMotion& motion) {
  WrenchLanes pressure_lanes, friction_lanes;
  for (int lane = 0; lane < kLanes; lane += kWidth)
    sumLane<kRightAngle, kFriction>(blocks, count, motion, lane, pressure_lanes, friction_lanes);
  FaceSums sums = {};
  WrenchTotal pressure, friction;
  pressure.add(pressure_lanes);
  pressure.sumLanes(sums.pressure);
  if (kFriction) {
    friction.add(friction_lanes);
    friction.sumLanes(sums.friction);
  }
  return sums;
}

FaceSums sumClusters(const ClusterBlock* blocks, std::size_t count, const SingleMotion& motion,
                     bool with_friction) {
  if (motion.signed_cosine_sq == 0)
    return with_friction ? sumClusters<true, true>(blocks, count, motion)
                         : sumClusters<true, false>(blocks, count, motion);
  return with_friction ? sumClusters<false, true>(blocks, count, motion)
                       : sumClusters<false, false>(blocks, count, motion);
}

}  // namespace
}  // namespace ambient
