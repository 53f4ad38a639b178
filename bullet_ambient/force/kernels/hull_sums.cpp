#include "bullet_ambient/force/kernels/hull_sums.h"

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/force/kernels/hull_rows.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the kernel.

namespace ambient {
namespace {

constexpr int kGroups = 32;  ///< number of groups of eight blocks per pass
static_assert(HullMoments::kBlocks == kLanes, "a group has one block per lane");

/// Blocks of one pass, sorted into wholly wet, cut and dry ones.
struct Choice {
  double wet[kGroups][kLanes];  ///< 1: wholly wet, else 0
  int cut[kGroups * kLanes];    ///< indices of cut blocks
  int cut_count = 0;
};

enum class Side { kDry, kCut, kWet };

/// Returns the side of the plane on which all corners of a block lie; kCut: on both sides.
inline Side sideOf(const HullBlock& block, const Planes& planes) {
  bool any_wet = false, any_dry = false;
  for (int lane = 0; lane < kLanes; lane += kWidth) {
    const WetCorners wet(planes.depth(load(block.corner[0], lane)),
                         planes.depth(load(block.corner[1], lane)),
                         planes.depth(load(block.corner[2], lane)));
    any_wet = any_wet || anyOf(wet.any());
    any_dry = any_dry || anyOf(~wet.all());
  }
  if (!any_wet) return Side::kDry;
  return any_dry ? Side::kCut : Side::kWet;
}

/// Sorts the blocks of `count` groups by their bounding boxes. Blocks whose box meets the plane are
/// sorted by their corners.
inline void choose(const HullMoments* groups, int count, const HullBlock* blocks,
                   const Planes& planes, Choice& choice) {
  choice.cut_count = 0;
  const Doubles zero = {}, one = zero + 1.0;
  for (int group = 0; group < count; ++group) {
    double open[kLanes];
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const Doubles depth = planes.depth(load(groups[group].centre, lane));
      const Doubles reach = dot(planes.size, load(groups[group].half, lane));
      const Mask is_wet = depth > reach;
      store(choice.wet[group] + lane, select(is_wet, one, zero));
      store(open + lane, select(is_wet, zero, select(depth >= -reach, one, zero)));
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      if (!(open[lane] > 0)) continue;
      const int block = group * kLanes + lane;
      const Side side = sideOf(blocks[block], planes);
      choice.wet[group][lane] = side == Side::kWet ? 1 : 0;
      if (side == Side::kCut) choice.cut[choice.cut_count++] = block;
    }
  }
}

/// Adds the triangles of cut blocks.
inline void addCut(const HullBlock* blocks, const Choice& choice, const Planes& planes,
                   HullRows (&sums)[kLanes / kWidth]) {
  for (int part = 0; part < kLanes / kWidth; ++part) {
    HullRows rows = sums[part];
    for (int i = 0; i < choice.cut_count; ++i)
      rows.addTriangles(blocks[choice.cut[i]], part * kWidth, planes);
    sums[part] = rows;
  }
}

/// Rows of partial sums over wholly wet blocks: s.N, s.M, s.Q of eq. (57).
enum WetRow { kFlux, kFluxMoment, kFluxSecond = kFluxMoment + 3, kWetRows = 10 };
struct WetRows {
  Doubles rows[kWetRows] = {};
};

/// Adds the moments of wholly wet blocks.
inline void addWet(const HullMoments* groups, int count, const Choice& choice, const Planes& planes,
                   WetRows (&sums)[kLanes / kWidth]) {
  for (int part = 0; part < kLanes / kWidth; ++part) {
    const int lane = part * kWidth;
    WetRows rows = sums[part];
    for (int group = 0; group < count; ++group) {
      const Doubles wet = load(choice.wet[group] + lane);
      if (!anyOf(wet > Doubles{})) continue;
      const auto& moments = groups[group].moments;
      const Vectors s = wet * planes.normal;
      const auto along = [&](int number, int stride) {
        return s.x * load(moments[number] + lane) + s.y * load(moments[number + stride] + lane) +
               s.z * load(moments[number + 2 * stride] + lane);
      };
      rows.rows[kFlux] = rows.rows[kFlux] + along(0, 1);
      for (int k = 0; k < 3; ++k)
        rows.rows[kFluxMoment + k] = rows.rows[kFluxMoment + k] + along(3 + k, 3);
      for (int k = 0; k < 6; ++k)
        rows.rows[kFluxSecond + k] = rows.rows[kFluxSecond + k] + along(12 + k, 6);
    }
    sums[part] = rows;
  }
}

/// Adds the lanes of each row.
template <class Rows, int kCount>
inline void sumRows(const Rows (&parts)[kLanes / kWidth], double (&sums)[kCount]) {
  for (int row = 0; row < kCount; ++row) {
    double lanes[kLanes];
    for (int part = 0; part < kLanes / kWidth; ++part)
      store(lanes + part * kWidth, parts[part].rows[row]);
    sums[row] = sumLanes(lanes);
  }
}

inline double dot(const double* a, const double* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Converts rows of cut blocks to HullSums.
inline HullSums sumsOf(const double (&r)[kRows]) {
  return {r[kVolume] / 3,
          r[kDepth] / 24,
          {r[kMoment] / 12, r[kMoment + 1] / 12},
          r[kArea] / 2,
          {r[kFirst] / 6, r[kFirst + 1] / 6},
          {r[kSecond] / 24, r[kSecond + 1] / 24, r[kSecond + 2] / 24}};
}

/// Adds the wholly wet blocks, docs/theory.md eq. (57).
inline void addWetTo(HullSums& sums, const double (&wet)[kWetRows], const HullPlane& plane) {
  const double h = plane.height, flux = wet[kFlux];
  const double* const sm = wet + kFluxMoment;
  const double* const q = wet + kFluxSecond;
  const double* const s = plane.normal;
  const double rows[3][3] = {{q[0], q[1], q[2]}, {q[1], q[3], q[4]}, {q[2], q[4], q[5]}};
  const double sqs[3] = {dot(rows[0], s), dot(rows[1], s), dot(rows[2], s)};
  const double sms = dot(s, sm);
  const double moment[3] = {sqs[0] - h * sm[0], sqs[1] - h * sm[1], sqs[2] - h * sm[2]};
  sums.volume += sms - h * flux;
  for (int axis = 0; axis < 2; ++axis) sums.moment[axis] += dot(plane.axes[axis], moment);
  sums.depth += h * sms - 0.5 * (h * h * flux + dot(s, sqs));
}

HullSums sumHull(const HullBlocks& hull, const HullPlane& plane) noexcept {
  const Planes planes(plane);
  HullRows cut[kLanes / kWidth];
  WetRows wet[kLanes / kWidth];
  Choice choice;
  const std::size_t groups = (hull.count + kLanes - 1) / kLanes;
  for (std::size_t begin = 0; begin < groups; begin += kGroups) {
    const std::size_t left = groups - begin;
    const int count = left < kGroups ? static_cast<int>(left) : kGroups;
    const HullBlock* const blocks = hull.blocks + begin * kLanes;
    choose(hull.moments + begin, count, blocks, planes, choice);
    addCut(blocks, choice, planes, cut);
    addWet(hull.moments + begin, count, choice, planes, wet);
  }
  double of_cut[kRows], of_wet[kWetRows];
  sumRows(cut, of_cut);
  sumRows(wet, of_wet);
  HullSums sums = sumsOf(of_cut);
  addWetTo(sums, of_wet, plane);
  return sums;
}

inline double absolute(double a) { return a < 0 ? -a : a; }

/// Returns the extent along s. Skips blocks whose bounding box lies within the extent found so far.
HullExtent extentOf(const HullCorners& corners, const double (&s)[3]) noexcept {
  const Vectors normal = broadcast(s);
  const double size[3] = {absolute(s[0]), absolute(s[1]), absolute(s[2])};
  HullExtent extent{};
  for (std::size_t i = 0; i < corners.count; ++i) {
    const HullPoints& block = corners.blocks[i];
    const double middle = dot(s, block.centre), reach = dot(size, block.half);
    if (i > 0 && middle - reach >= extent.low && middle + reach <= extent.high) continue;
    Doubles low = dot(normal, load(block.place, 0)), high = low;
    for (int at = kWidth; at < HullPoints::kPoints; at += kWidth) {
      const Doubles along = dot(normal, load(block.place, at));
      low = along < low ? along : low;
      high = along > high ? along : high;
    }
    double lows[kWidth], highs[kWidth];
    store(lows, low);
    store(highs, high);
    if (i == 0) extent = {lows[0], highs[0]};
    for (int lane = 0; lane < kWidth; ++lane) {
      if (lows[lane] < extent.low) extent.low = lows[lane];
      if (highs[lane] > extent.high) extent.high = highs[lane];
    }
  }
  return extent;
}

}  // namespace

const HullKernel AMBIENT_KERNEL(kHullKernel){sumHull, extentOf};

}  // namespace ambient
