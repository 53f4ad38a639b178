#include "bullet_ambient/force/kernels/part_sums.h"

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/base/lanes.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the kernel.

namespace ambient {
namespace {

constexpr int kLanes = 8;
static_assert(PartBlock::kParts == kLanes, "a block has one part per lane");

/// Returns the depths of the centres of parts.
inline Doubles depthOf(const PartBlock& block, int lane, const PartPlane& plane) {
  const double(&s)[3] = plane.normal;
  return plane.height -
         (s[0] * loadDoubles(block.centre[0] + lane) + s[1] * loadDoubles(block.centre[1] + lane) +
          s[2] * loadDoubles(block.centre[2] + lane));
}

/// Depths of the three Gauss points of a part. Their weighted mean and mean square along s are
/// those of the part.
struct Depths {
  Doubles above, middle, below;
  Doubles way;       // difference in depth between the outer points and the middle one
  Doubles slope[3];  // derivative of way^2 / 2 with respect to s

  Depths(const PartBlock& block, int lane, const PartPlane& plane) {
    const double(&s)[3] = plane.normal;
    const auto spread = [&](int k) { return loadDoubles(block.spread[k] + lane); };
    middle = depthOf(block, lane, plane);
    // way^2 = kNode s.C s: Gauss points lie at sqrt(3/5) of the half width sqrt(3 s.C s).
    constexpr double kNode = 9.0 / 5;
    slope[0] = kNode * (s[0] * spread(0) + s[1] * spread(3) + s[2] * spread(4));
    slope[1] = kNode * (s[0] * spread(3) + s[1] * spread(1) + s[2] * spread(5));
    slope[2] = kNode * (s[0] * spread(4) + s[1] * spread(5) + s[2] * spread(2));
    const Doubles square = s[0] * slope[0] + s[1] * slope[1] + s[2] * slope[2];
    const Doubles zero = {};
    way = squareRoot(square > zero ? square : zero);
    above = middle - way;
    below = middle + way;
  }
};

/// Weights zeta / (zeta + reach) of the three points of a part; 0 above the surface. One division
/// serves all three.
struct Weights {
  Doubles depth[3], sum[3], per;

  Weights(const Depths& depths, double reach) {
    constexpr double kLeast = 1e-100;  // avoids 0 / 0
    const Doubles zero = {};
    const Doubles* const points[3] = {&depths.above, &depths.middle, &depths.below};
    for (int i = 0; i < 3; ++i) {
      depth[i] = *points[i] > zero ? *points[i] : zero;
      sum[i] = depth[i] + (reach + kLeast);
    }
    per = 1.0 / (sum[0] * sum[1] * sum[2]);
  }
  /// Returns 1 / sum[i].
  Doubles perSum(int i) const { return per * (sum[(i + 1) % 3] * sum[(i + 2) % 3]); }
  /// Returns the mean weight of the part, by the Gauss weights 5/18, 8/18, 5/18.
  Doubles share() const {
    const Doubles outer = 5 * (depth[0] * perSum(0)) + 5 * (depth[2] * perSum(2));
    return (1.0 / 18) * (outer + 8 * (depth[1] * perSum(1)));
  }
  /// Returns the derivative of the weight of point i with respect to its depth.
  Doubles slope(int i, double reach) const {
    const Doubles zero = {}, p = perSum(i);
    return depth[i] > zero ? reach * (p * p) : zero;
  }
};

constexpr int kTogether = 4;           ///< number of blocks whose entries are read side by side
constexpr int kChunk = 8 * kTogether;  ///< number of blocks per pass

/// Blocks that may have a part in the water among the kWidth lanes from `lane`; all other blocks
/// add nothing. `Wet`: factors of a sum for the parts of a block.
template <class Wet>
class WetBlocks {
 public:
  /// Finds wet blocks among the kChunk blocks from `begin` on. Fills the last group of kTogether
  /// with blocks of weight 0.
  WetBlocks(const PartBlocks& parts, std::size_t begin, int lane, const PartPlane& plane) {
    const std::size_t left = parts.count - begin;
    const PartBlock* const blocks = parts.blocks + begin;
    for (std::size_t i = 0; i < (left < kChunk ? left : kChunk); ++i) {
      const Doubles middle = depthOf(blocks[i], lane, plane);
      if (!anyOf(middle + loadDoubles(blocks[i].reach + lane) > Doubles{})) continue;
      const Depths depths(blocks[i], lane, plane);
      blocks_[count_] = blocks + i;
      wet_[count_] = Wet(depths, plane.reach);
      if (parts.shares) wet_[count_].scale(load(parts.shares + lane));
      ++count_;
    }
    for (; count_ % kTogether != 0; ++count_) {
      blocks_[count_] = blocks;
      wet_[count_] = {};
    }
  }

  int count() const { return count_; }
  const PartBlock& block(int i) const { return *blocks_[i]; }
  const Wet& operator[](int i) const { return wet_[i]; }

 private:
  int count_ = 0;
  const PartBlock* blocks_[kChunk];
  Wet wet_[kChunk];
};

/// Weights of parts, for the inertia.
struct WetShare {
  Doubles share;

  WetShare() = default;
  WetShare(const Depths& depths, double reach) : share(Weights(depths, reach).share()) {}
  void scale(const Doubles& factor) { share = factor * share; }
};

PartInertia sumInertia(const PartBlocks& parts, const PartPlane& plane) noexcept {
  double lanes[PartBlock::kEntries][kLanes] = {};
  for (std::size_t begin = 0; begin < parts.count; begin += kChunk)
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const WetBlocks<WetShare> wet(parts, begin, lane, plane);
      for (int first = 0; first < wet.count(); first += kTogether)
        for (int entry = 0; entry < PartBlock::kEntries; ++entry) {
          Doubles sum = load(lanes[entry] + lane);
          for (int i = first; i < first + kTogether; ++i)
            sum = sum + wet[i].share * loadDoubles(wet.block(i).inertia[entry] + lane);
          store(lanes[entry] + lane, sum);
        }
    }
  PartInertia sum;
  for (int entry = 0; entry < PartBlock::kEntries; ++entry)
    sum.entries[entry] = sumLanes(lanes[entry]);
  return sum;
}

/// Derivatives of 18 times the weights of parts, for the gradient.
struct WetSlope {
  Doubles by_height, by_spread;
  Doubles spread[3];  ///< Depths::slope

  WetSlope() = default;
  WetSlope(const Depths& depths, double reach) {
    const Doubles zero = {};
    const Weights weights(depths, reach);
    const Doubles above = 5 * weights.slope(0, reach), below = 5 * weights.slope(2, reach);
    by_height = above + 8 * weights.slope(1, reach) + below;
    by_spread = depths.way > zero ? (below - above) / depths.way : zero;
    for (int axis = 0; axis < 3; ++axis) spread[axis] = depths.slope[axis];
  }
  void scale(const Doubles& factor) {
    by_height = factor * by_height;
    by_spread = factor * by_spread;
  }
};

PartGradient sumGradient(const PartBlocks& parts, const PartPlane& plane,
                         const double (&products)[PartBlock::kEntries]) noexcept {
  double lanes[4][kLanes] = {};
  for (std::size_t begin = 0; begin < parts.count; begin += kChunk)
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const WetBlocks<WetSlope> wet(parts, begin, lane, plane);
      Doubles sums[4];
      for (int i = 0; i < 4; ++i) sums[i] = load(lanes[i] + lane);
      for (int first = 0; first < wet.count(); first += kTogether) {
        Doubles energy[kTogether] = {};
        for (int entry = 0; entry < PartBlock::kEntries; ++entry)
          for (int i = 0; i < kTogether; ++i)
            energy[i] = energy[i] +
                        products[entry] * loadDoubles(wet.block(first + i).inertia[entry] + lane);
        for (int i = 0; i < kTogether; ++i) {
          const WetSlope& slope = wet[first + i];
          const PartBlock& block = wet.block(first + i);
          const Doubles part = (1.0 / 18) * energy[i];
          const Doubles t = slope.by_height * part, apart = slope.by_spread * part;
          sums[0] = sums[0] + t;
          for (int axis = 0; axis < 3; ++axis)
            sums[axis + 1] = sums[axis + 1] - t * loadDoubles(block.centre[axis] + lane) +
                             apart * slope.spread[axis];
        }
      }
      for (int i = 0; i < 4; ++i) store(lanes[i] + lane, sums[i]);
    }
  return {sumLanes(lanes[0]), {sumLanes(lanes[1]), sumLanes(lanes[2]), sumLanes(lanes[3])}};
}

}  // namespace

const PartKernel AMBIENT_KERNEL(kPartKernel){sumInertia, sumGradient};

}  // namespace ambient
