#include "bullet_ambient/force/kernels/level_sums.h"

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/force/kernels/even_part.h"
#include "bullet_ambient/force/kernels/single_lanes.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the function.

namespace ambient {
namespace {

static_assert(ClusterBlock::kClusters == kLanes, "a block has one cluster per lane");

/// 6-vectors, one per lane.
struct Sixes {
  Vectors torque, force;
};

inline Sixes load(const float (&rows)[6][kLanes], int lane) {
  return {{load(rows[0] + lane), load(rows[1] + lane), load(rows[2] + lane)},
          {load(rows[3] + lane), load(rows[4] + lane), load(rows[5] + lane)}};
}

/// Returns a.(w, v).
inline Floats dot(const Sixes& a, const Vectors& w, const Vectors& v) {
  const Floats turning = dot(a.torque, w);
  return plusProduct(plusProduct(plusProduct(turning, a.force.x, v.x), a.force.y, v.y), a.force.z,
                     v.z);
}

/// Returns e(z) of eq. (37), the attached share of a cluster minus one half. The cluster is taken
/// for a disc; z is the distance of the terminator from its centre in radii. `a`: g.x, `spread_sq`:
/// s^2.
inline Floats attachedExcess(Floats a, Floats spread_sq) {
  Floats z = (0.5f * a) * inverseRoot(spread_sq);
  z = z > 1.0f ? Floats{} + 1.0f : z;
  z = z < -1.0f ? Floats{} - 1.0f : z;
  return z * lessProduct(Floats{} + 0.63661977f, Floats{} + 0.13661977f, z * z);
}

/// Returns |u| |cos(alpha)|. The flow is attached where n.u is above minus this value, eq. (13).
inline Floats reach(float cosine, Vectors u) {
  constexpr float kLeastSquare = 1e-30f;  // keeps the root of a cluster at rest finite
  const Floats u_sq = dot(u, u) + kLeastSquare;
  return cosine * (u_sq * inverseRoot(u_sq));
}

/// Sums all clusters in the kWidth lanes from `lane`, eq. (38) without T, and (39).
template <bool kRightAngle, bool kFriction>
void sumLane(const ClusterBlock* blocks, std::size_t count, const SingleMotion& motion, int lane,
             WrenchLanes& sums) {
  // Keeps z of eq. (37) finite for a flat cluster, whose spread_sq is 0.
  constexpr float kLeastSpread = 1e-14f;
  const Vectors w = broadcast(motion.angular);
  const Vectors v = broadcast(motion.linear);
  const float cosine = kRightAngle ? 0 : __builtin_sqrtf(motion.signed_cosine_sq);  // |cos(alpha)|
  Vectors torque = {}, force = {};
  for (std::size_t i = 0; i < count; ++i) {
    const ClusterBlock& block = blocks[i];
    const Sixes g = load(block.switching, lane);
    const Floats a = dot(g, w, v);
    const Floats b1 = dot(load(block.spread[0], lane), w, v);
    const Floats b2 = dot(load(block.spread[1], lane), w, v);
    const Floats spread_sq = plusProduct(plusProduct(Floats{} + kLeastSpread, b1, b1), b2, b2);
    const Vectors c = load(block.centroid, lane);
    const Vectors u = plusCross(v, w, c);
    const Floats excess = attachedExcess(kRightAngle ? a : a + reach(cosine, u), spread_sq);
    const Vectors t = lessProduct(u, dot(g.force, u), g.force);
    const Floats slip_sq = dot(t, t);
    const Floats part = kRightAngle ? excess : excess - 0.5f;
    const Floats by_slip = part * slip_sq;
    const Floats by_normal = part * plusProduct(spread_sq, a, a);
    const Sixes slip = load(block.by_slip, lane);
    const Sixes normal = load(block.by_normal, lane);
    torque = plusProduct(plusProduct(torque, by_slip, slip.torque), by_normal, normal.torque);
    force = plusProduct(plusProduct(force, by_slip, slip.force), by_normal, normal.force);
    if (kFriction) {
      const Floats area = (load(block.area + lane) * motion.friction) * (0.5f + excess);
      const Vectors f = ((area * slip_sq) * slipPower(slip_sq)) * t;
      force = force + f;
      torque = plusCross(torque, c, f);
    }
  }
  sums.set(torque, force, lane);
}

template <bool kRightAngle, bool kFriction>
LoadSums sumClusters(const LevelColumns& level, const double (&x)[6], const SingleMotion& motion) {
  WrenchLanes lanes;
  for (int lane = 0; lane < kLanes; lane += kWidth)
    sumLane<kRightAngle, kFriction>(level.blocks, level.count, motion, lane, lanes);
  WrenchTotal<> total;
  total.add(lanes);
  LoadSums sums = total.sum();
  addEvenPart(level.even, x, sums);
  return sums;
}

}  // namespace

LoadSums AMBIENT_KERNEL(sumClusters)(const LevelColumns& level, const double (&x)[6],
                                     const SingleMotion& motion) noexcept {
  const bool friction = motion.friction > 0;
  if (motion.signed_cosine_sq == 0)
    return friction ? sumClusters<true, true>(level, x, motion)
                    : sumClusters<true, false>(level, x, motion);
  return friction ? sumClusters<false, true>(level, x, motion)
                  : sumClusters<false, false>(level, x, motion);
}

}  // namespace ambient
