#pragma once

#include "bullet_ambient/force/double_lanes.h"
#include "bullet_ambient/force/part_sums.h"

// Included once by each part_sums_<instruction set>.cpp, which is compiled for that set and names
// the AMBIENT_KERNEL.

namespace ambient {
namespace {

constexpr int kLanes = 8;
static_assert(PartBlock::kParts == kLanes, "a block has one part per lane");

/// The depths of a part, as three Gauss points of a patch that has its mean square along s.
struct Depths {
  Doubles above, middle, below;
  Doubles way;       // of the outer points from the middle
  Doubles slope[3];  // of half its square, by s

  Depths(const PartBlock& block, int lane, const PartPlane& plane) {
    const double(&s)[3] = plane.normal;
    const auto centre = [&](int axis) { return load(block.centre[axis] + lane); };
    const auto spread = [&](int k) { return load(block.spread[k] + lane); };
    middle = plane.height - (s[0] * centre(0) + s[1] * centre(1) + s[2] * centre(2));
    constexpr double kNode = 9.0 / 5;  // sqrt(3/5) of a half width sqrt(3 s.C s)
    slope[0] = kNode * (s[0] * spread(0) + s[1] * spread(3) + s[2] * spread(4));
    slope[1] = kNode * (s[0] * spread(3) + s[1] * spread(1) + s[2] * spread(5));
    slope[2] = kNode * (s[0] * spread(4) + s[1] * spread(5) + s[2] * spread(2));
    const Doubles square = s[0] * slope[0] + s[1] * slope[1] + s[2] * slope[2];
    const Doubles zero = {};
    way = root(square > zero ? square : zero);
    above = middle - way;
    below = middle + way;
  }
};

/// Of the three points of each part: 0 above the surface, and what is added to the reach; one
/// division serves all three.
struct Weights {
  Doubles depth[3], sum[3], per;

  Weights(const Depths& depths, double reach) {
    constexpr double kLeast = 1e-100;  // keeps 0 / 0 away
    const Doubles zero = {};
    const Doubles* const points[3] = {&depths.above, &depths.middle, &depths.below};
    for (int i = 0; i < 3; ++i) {
      depth[i] = *points[i] > zero ? *points[i] : zero;
      sum[i] = depth[i] + (reach + kLeast);
    }
    per = 1.0 / (sum[0] * sum[1] * sum[2]);
  }
  /// One over a sum.
  Doubles perSum(int i) const { return per * (sum[(i + 1) % 3] * sum[(i + 2) % 3]); }
  /// Mean of zeta / (zeta + reach).
  Doubles share() const {
    const Doubles outer = 5 * (depth[0] * perSum(0)) + 5 * (depth[2] * perSum(2));
    return (1.0 / 18) * (outer + 8 * (depth[1] * perSum(1)));
  }
  /// Derivative of one of them.
  Doubles slope(int i, double reach) const {
    const Doubles zero = {}, p = perSum(i);
    return depth[i] > zero ? reach * (p * p) : zero;
  }
};

constexpr int kChunk = 16;  ///< blocks that are weighted at a time

PartInertia sumInertia(const PartBlocks& parts, const PartPlane& plane) noexcept {
  double lanes[PartBlock::kEntries][kLanes] = {};
  for (std::size_t begin = 0; begin < parts.count; begin += kChunk) {
    const PartBlock* const blocks = parts.blocks + begin;
    const std::size_t left = parts.count - begin;
    const int count = left < kChunk ? static_cast<int>(left) : kChunk;
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      Doubles shares[kChunk];
      for (int i = 0; i < count; ++i)
        shares[i] = Weights(Depths(blocks[i], lane, plane), plane.reach).share();
      for (int entry = 0; entry < PartBlock::kEntries; ++entry) {
        Doubles sum = load(lanes[entry] + lane);
        for (int i = 0; i < count; ++i)
          sum = sum + shares[i] * load(blocks[i].inertia[entry] + lane);
        store(lanes[entry] + lane, sum);
      }
    }
  }
  PartInertia sum;
  for (int entry = 0; entry < PartBlock::kEntries; ++entry)
    sum.entries[entry] = sumLanes(lanes[entry]);
  return sum;
}

PartGradient sumGradient(const PartBlocks& parts, const PartPlane& plane,
                         const double (&products)[PartBlock::kEntries]) noexcept {
  double lanes[4][kLanes] = {};
  const Doubles zero = {};
  for (std::size_t i = 0; i < parts.count; ++i)
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const PartBlock& block = parts.blocks[i];
      const Depths depths(block, lane, plane);
      const Weights weights(depths, plane.reach);
      const Doubles above = 5 * weights.slope(0, plane.reach);
      const Doubles below = 5 * weights.slope(2, plane.reach);
      Doubles energy = {};
      for (int entry = 0; entry < PartBlock::kEntries; ++entry)
        energy = energy + products[entry] * load(block.inertia[entry] + lane);
      energy = (1.0 / 18) * energy;
      const Doubles t = (above + 8 * weights.slope(1, plane.reach) + below) * energy;
      const Doubles apart = depths.way > zero ? (below - above) * energy / depths.way : zero;
      store(lanes[0] + lane, load(lanes[0] + lane) + t);
      for (int axis = 0; axis < 3; ++axis)
        store(lanes[axis + 1] + lane, load(lanes[axis + 1] + lane) -
                                          t * load(block.centre[axis] + lane) +
                                          apart * depths.slope[axis]);
    }
  return {sumLanes(lanes[0]), {sumLanes(lanes[1]), sumLanes(lanes[2]), sumLanes(lanes[3])}};
}

}  // namespace

const PartKernel AMBIENT_KERNEL{sumInertia, sumGradient};

}  // namespace ambient
