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

/// zeta / (zeta + reach), and its derivative; 0 above the surface.
struct Weight {
  double reach;
  double least = 1e-300;  // keeps 0 / 0 away

  Doubles at(const Doubles& depth) const {
    const Doubles zero = {};
    const Doubles wet = depth > zero ? depth : zero;
    return wet / (wet + (reach + least));
  }
  Doubles slopeAt(const Doubles& depth) const {
    const Doubles zero = {};
    const Doubles sum = (depth > zero ? depth : zero) + (reach + least);
    return depth > zero ? reach / (sum * sum) : zero;
  }
};

PartInertia sumInertia(const PartBlocks& parts, const PartPlane& plane) noexcept {
  double lanes[PartBlock::kEntries][kLanes] = {};
  const Weight weight{plane.reach};
  for (std::size_t i = 0; i < parts.count; ++i)
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const Depths depths(parts.blocks[i], lane, plane);
      const Doubles share = (5 * weight.at(depths.above) + 8 * weight.at(depths.middle) +
                             5 * weight.at(depths.below)) /
                            18;
      for (int entry = 0; entry < PartBlock::kEntries; ++entry)
        store(lanes[entry] + lane,
              load(lanes[entry] + lane) + share * load(parts.blocks[i].inertia[entry] + lane));
    }
  PartInertia sum;
  for (int entry = 0; entry < PartBlock::kEntries; ++entry)
    sum.entries[entry] = sumLanes(lanes[entry]);
  return sum;
}

PartGradient sumGradient(const PartBlocks& parts, const PartPlane& plane,
                         const double (&products)[PartBlock::kEntries]) noexcept {
  double lanes[4][kLanes] = {};
  const Weight weight{plane.reach};
  for (std::size_t i = 0; i < parts.count; ++i)
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const PartBlock& block = parts.blocks[i];
      const Depths depths(block, lane, plane);
      const Doubles above = 5 * weight.slopeAt(depths.above);
      const Doubles below = 5 * weight.slopeAt(depths.below);
      Doubles energy = {};
      for (int entry = 0; entry < PartBlock::kEntries; ++entry)
        energy = energy + products[entry] * load(block.inertia[entry] + lane);
      energy = energy / 18;
      const Doubles t = (above + 8 * weight.slopeAt(depths.middle) + below) * energy;
      const Doubles zero = {};
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
