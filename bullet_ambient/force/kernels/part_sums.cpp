#include "bullet_ambient/force/kernels/part_sums.h"

#include <type_traits>

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
  Doubles offset;    // difference in depth between the outer points and the middle one
  Doubles slope[3];  // derivative of offset^2 / 2 with respect to s

  Depths(const PartBlock& block, int lane, const PartPlane& plane) {
    const double(&s)[3] = plane.normal;
    const auto spread = [&](int k) { return loadDoubles(block.spread[k] + lane); };
    middle = depthOf(block, lane, plane);
    // offset^2 = kNode s.C s: Gauss points lie at sqrt(3/5) of the half width sqrt(3 s.C s).
    constexpr double kNode = 9.0 / 5;
    slope[0] = kNode * (s[0] * spread(0) + s[1] * spread(3) + s[2] * spread(4));
    slope[1] = kNode * (s[0] * spread(3) + s[1] * spread(1) + s[2] * spread(5));
    slope[2] = kNode * (s[0] * spread(4) + s[1] * spread(5) + s[2] * spread(2));
    const Doubles square = s[0] * slope[0] + s[1] * slope[1] + s[2] * slope[2];
    const Doubles zero = {};
    offset = squareRoot(square > zero ? square : zero);
    above = middle - offset;
    below = middle + offset;
  }
};

/// Weights zeta / (zeta + reach) of the three points of a part; 0 above the surface. One division
/// serves all three.
struct Weights {
  Doubles depth[3], sum[3], inverse_product;

  Weights(const Depths& depths, double reach) {
    constexpr double kLeast = 1e-100;  // avoids 0 / 0
    const Doubles zero = {};
    const Doubles* const points[3] = {&depths.above, &depths.middle, &depths.below};
    for (int i = 0; i < 3; ++i) {
      depth[i] = *points[i] > zero ? *points[i] : zero;
      sum[i] = depth[i] + (reach + kLeast);
    }
    inverse_product = 1.0 / (sum[0] * sum[1] * sum[2]);
  }
  /// Returns 1 / sum[i].
  Doubles inverseSum(int i) const {
    return inverse_product * (sum[(i + 1) % 3] * sum[(i + 2) % 3]);
  }
  /// Returns the mean weight of the part, by the Gauss weights 5/18, 8/18, 5/18.
  Doubles share() const {
    const Doubles outer = 5 * (depth[0] * inverseSum(0)) + 5 * (depth[2] * inverseSum(2));
    return (1.0 / 18) * (outer + 8 * (depth[1] * inverseSum(1)));
  }
  /// Returns the derivative of the weight of point i with respect to its depth.
  Doubles slope(int i, double reach) const {
    const Doubles zero = {}, p = inverseSum(i);
    return depth[i] > zero ? reach * (p * p) : zero;
  }
};

/// Images of a body that so many mirror each other; kImages = 1: no mirrors.
template <int kImages>
struct Images {
  PartPlane planes[kImages];       ///< the water surface as the part that is kept sees it
  int turned[kImages];             ///< axes, as bits
  int kinds[PartBlock::kEntries];  ///< bits of image numbers that turn the sign of an entry
  Images(int mirrors, const PartPlane& plane) {
    for (int image = 0; image < kImages; ++image) {
      turned[image] = imageOf(mirrors, image);
      planes[image] = plane;
      for (int axis = 0; axis < 3; ++axis)
        if (turned[image] >> axis & 1) planes[image].normal[axis] = -plane.normal[axis];
    }
    int entry = 0;
    for (int row = 0; row < 6; ++row)
      for (int column = row; column < 6; ++column, ++entry) {
        kinds[entry] = 0;
        for (int bit = 1; bit < kImages; bit *= 2)
          if ((kTurnedBy[row] ^ kTurnedBy[column]) & turned[bit]) kinds[entry] |= bit;
      }
  }
  int kindOf(int entry) const { return kImages == 1 ? 0 : kinds[entry]; }

  /// Replaces one number of each image by the sums over images with the signs of each kind of
  /// entry, or the other way round.
  static void combine(Doubles (&numbers)[kImages]) {
    for (int bit = 1; bit < kImages; bit *= 2)
      for (int k = 0; k < kImages; ++k) {
        if (k & bit) continue;
        const Doubles a = numbers[k], b = numbers[k | bit];
        numbers[k] = a + b;
        numbers[k | bit] = a - b;
      }
  }
};

/// Number of blocks whose entries are read side by side.
template <int kImages>
constexpr int kTogether = kImages == 1 ? 4 : 1;

/// Blocks that may have a part in the water among the kWidth lanes from `lane`; all other blocks
/// add nothing. `Wet`: factors of a sum for the parts of a block.
template <template <int> class Wet, int kImages>
class WetBlocks {
 public:
  static constexpr int kChunk = 8 * kTogether<kImages>;  ///< number of blocks per pass

  /// Finds wet blocks among the kChunk blocks from `begin` on. Fills the last group of kTogether
  /// with blocks of weight 0.
  WetBlocks(const PartBlocks& parts, std::size_t begin, int lane, const Images<kImages>& images) {
    const std::size_t left = parts.count - begin;
    const PartBlock* const blocks = parts.blocks + begin;
    for (std::size_t i = 0; i < (left < kChunk ? left : kChunk); ++i) {
      Mask may_be_wet = {};
      for (const PartPlane& plane : images.planes)
        may_be_wet |=
            depthOf(blocks[i], lane, plane) + loadDoubles(blocks[i].reach + lane) > Doubles{};
      if (!anyOf(may_be_wet)) continue;
      blocks_[count_] = blocks + i;
      for (int image = 0; image < kImages; ++image) {
        wet_[count_].set(image, Depths(blocks[i], lane, images.planes[image]),
                         images.planes[image].reach);
        if (parts.shares) wet_[count_].scale(image, load(parts.shares + image * kLanes + lane));
      }
      ++count_;
    }
    for (; count_ % kTogether<kImages> != 0; ++count_) {
      blocks_[count_] = blocks;
      wet_[count_] = {};
    }
  }

  int count() const { return count_; }
  const PartBlock& block(int i) const { return *blocks_[i]; }
  const Wet<kImages>& operator[](int i) const { return wet_[i]; }
  Wet<kImages>& operator[](int i) { return wet_[i]; }

 private:
  int count_ = 0;
  const PartBlock* blocks_[kChunk];
  Wet<kImages> wet_[kChunk];
};

/// Weights of parts, for the inertia.
template <int kImages>
struct WetShare {
  Doubles share[kImages];

  void set(int image, const Depths& depths, double reach) {
    share[image] = Weights(depths, reach).share();
  }
  void scale(int image, const Doubles& factor) { share[image] = factor * share[image]; }
};

template <int kImages>
PartInertia sumInertia(const PartBlocks& parts, const PartPlane& plane) noexcept {
  using Blocks = WetBlocks<WetShare, kImages>;
  const Images<kImages> images(parts.mirrors, plane);
  double lanes[PartBlock::kEntries][kLanes] = {};
  for (std::size_t begin = 0; begin < parts.count; begin += Blocks::kChunk)
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      Blocks wet(parts, begin, lane, images);
      for (int i = 0; i < wet.count(); ++i) images.combine(wet[i].share);
      for (int first = 0; first < wet.count(); first += kTogether<kImages>)
        for (int entry = 0; entry < PartBlock::kEntries; ++entry) {
          Doubles sum = load(lanes[entry] + lane);
          for (int i = first; i < first + kTogether<kImages>; ++i)
            sum = sum + wet[i].share[images.kindOf(entry)] *
                            loadDoubles(wet.block(i).inertia[entry] + lane);
          store(lanes[entry] + lane, sum);
        }
    }
  PartInertia sum;
  for (int entry = 0; entry < PartBlock::kEntries; ++entry)
    sum.entries[entry] = sumLanes(lanes[entry]);
  return sum;
}

/// Derivatives of 18 times the weights of parts, for the gradient.
template <int kImages>
struct WetSlope {
  Doubles by_height[kImages], by_spread[kImages];
  Doubles spread[kImages][3];  ///< Depths::slope

  void set(int image, const Depths& depths, double reach) {
    const Doubles zero = {};
    const Weights weights(depths, reach);
    const Doubles above = 5 * weights.slope(0, reach), below = 5 * weights.slope(2, reach);
    by_height[image] = above + 8 * weights.slope(1, reach) + below;
    by_spread[image] = depths.offset > zero ? (below - above) / depths.offset : zero;
    for (int axis = 0; axis < 3; ++axis) spread[image][axis] = depths.slope[axis];
  }
  void scale(int image, const Doubles& factor) {
    by_height[image] = factor * by_height[image];
    by_spread[image] = factor * by_spread[image];
  }
};

template <int kImages>
PartGradient sumGradient(const PartBlocks& parts, const PartPlane& plane,
                         const double (&products)[PartBlock::kEntries]) noexcept {
  using Blocks = WetBlocks<WetSlope, kImages>;
  constexpr int kSide = kTogether<kImages>;
  const Images<kImages> images(parts.mirrors, plane);
  double lanes[4][kLanes] = {};
  for (std::size_t begin = 0; begin < parts.count; begin += Blocks::kChunk)
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const Blocks wet(parts, begin, lane, images);
      Doubles sums[4];
      for (int i = 0; i < 4; ++i) sums[i] = load(lanes[i] + lane);
      for (int first = 0; first < wet.count(); first += kSide) {
        Doubles energy[kSide][kImages] = {};
        for (int entry = 0; entry < PartBlock::kEntries; ++entry)
          for (int i = 0; i < kSide; ++i) {
            Doubles& of_kind = energy[i][images.kindOf(entry)];
            of_kind =
                of_kind + products[entry] * loadDoubles(wet.block(first + i).inertia[entry] + lane);
          }
        for (int i = 0; i < kSide; ++i) {
          const WetSlope<kImages>& slope = wet[first + i];
          const PartBlock& block = wet.block(first + i);
          images.combine(energy[i]);
          for (int image = 0; image < kImages; ++image) {
            const Doubles part = (1.0 / 18) * energy[i][image];
            const Doubles t = slope.by_height[image] * part, apart = slope.by_spread[image] * part;
            sums[0] = sums[0] + t;
            for (int axis = 0; axis < 3; ++axis) {
              const double sign = kImages > 1 && images.turned[image] >> axis & 1 ? -1 : 1;
              sums[axis + 1] = sums[axis + 1] - sign * t * loadDoubles(block.centre[axis] + lane) +
                               sign * apart * slope.spread[image][axis];
            }
          }
        }
      }
      for (int i = 0; i < 4; ++i) store(lanes[i] + lane, sums[i]);
    }
  return {sumLanes(lanes[0]), {sumLanes(lanes[1]), sumLanes(lanes[2]), sumLanes(lanes[3])}};
}

/// Calls sum with the number of images as a constant.
template <class Sum>
auto withImages(const PartBlocks& parts, const Sum& sum) {
  switch (parts.images()) {
    case 8:
      return sum(std::integral_constant<int, 8>());
    case 4:
      return sum(std::integral_constant<int, 4>());
    case 2:
      return sum(std::integral_constant<int, 2>());
    default:
      return sum(std::integral_constant<int, 1>());
  }
}

PartInertia weightedInertia(const PartBlocks& parts, const PartPlane& plane) noexcept {
  return withImages(parts, [&](auto images) { return sumInertia<images>(parts, plane); });
}

PartGradient weightedGradient(const PartBlocks& parts, const PartPlane& plane,
                              const double (&products)[PartBlock::kEntries]) noexcept {
  return withImages(parts,
                    [&](auto images) { return sumGradient<images>(parts, plane, products); });
}

}  // namespace

const PartKernel AMBIENT_KERNEL(kPartKernel){weightedInertia, weightedGradient};

}  // namespace ambient
