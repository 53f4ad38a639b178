#pragma once

#include "bullet_ambient/force/double_lanes.h"
#include "bullet_ambient/force/hull_sums.h"

// Included once by each hull_sums_<instruction set>.cpp, which is compiled for that set and names
// the AMBIENT_KERNEL.

namespace ambient {
namespace {

constexpr int kLanes = 8;
constexpr int kGroups = 32;  ///< groups of eight blocks that are looked at together
static_assert(HullMoments::kBlocks == kLanes, "a block of a group is a lane");
static_assert(HullBlock::kTriangles % kLanes == 0, "a block is whole rows of lanes");

inline Vectors broadcast(const double (&v)[3]) {
  return {Doubles{} + v[0], Doubles{} + v[1], Doubles{} + v[2]};
}
template <int kColumns>
inline Vectors load(const double (&columns)[3][kColumns], int at) {
  return {load(columns[0] + at), load(columns[1] + at), load(columns[2] + at)};
}
inline Doubles select(const Mask& mask, const Doubles& a, const Doubles& b) { return mask ? a : b; }
inline Vectors select(const Mask& mask, const Vectors& a, const Vectors& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// A corner of each triangle.
struct Corners {
  Vectors place;
  Doubles depth;
};
inline Corners select(const Mask& mask, const Corners& a, const Corners& b) {
  return {select(mask, a.place, b.place), select(mask, a.depth, b.depth)};
}

/// The plane in all lanes.
struct Planes {
  Vectors normal, axis1, axis2;
  Doubles height;

  explicit Planes(const HullPlane& plane)
      : normal(broadcast(plane.normal)),
        axis1(broadcast(plane.axes[0])),
        axis2(broadcast(plane.axes[1])),
        height(Doubles{} + plane.height) {}
  Corners corners(const Vectors& place) const { return {place, height - dot(normal, place)}; }
};

/// 3 V, 12 W, 12 (S - s W) of the integrals, and 2, 6, 24 times those of the waterplane, per lane.
enum Row {
  kVolume,
  kDepth,
  kMoment,
  kArea = kMoment + 3,
  kFirst,
  kSecond = kFirst + 2,
  kRows = 11
};
struct HullLanes {
  double rows[kRows][kLanes] = {};
};

struct HullRows {
  Doubles rows[kRows];

  HullRows(const HullLanes& lanes, int lane) {
    for (int row = 0; row < kRows; ++row) rows[row] = load(lanes.rows[row] + lane);
  }
  void storeTo(HullLanes& lanes, int lane) const {
    for (int row = 0; row < kRows; ++row) store(lanes.rows[row] + lane, rows[row]);
  }
  void addMoment(const Doubles& factor, const Vectors& moment) {
    rows[kMoment] = rows[kMoment] + factor * moment.x;
    rows[kMoment + 1] = rows[kMoment + 1] + factor * moment.y;
    rows[kMoment + 2] = rows[kMoment + 2] + factor * moment.z;
  }

  /// Whole triangles, docs/theory.md eq. (55); `flux`: -s.n A, or 0 where it is not wet.
  void addWhole(const Corners& a, const Corners& b, const Corners& c, const Doubles& flux) {
    const Doubles sum = a.depth + b.depth + c.depth;
    const Doubles squares = a.depth * a.depth + b.depth * b.depth + c.depth * c.depth +
                            (a.depth * b.depth + b.depth * c.depth + c.depth * a.depth);
    rows[kVolume] = rows[kVolume] + flux * sum;
    rows[kDepth] = rows[kDepth] + flux * squares;
    addMoment(flux, sum * (a.place + b.place + c.place) +
                        (a.depth * a.place + b.depth * b.place + c.depth * c.place));
  }

  /// The corner u of triangles that the plane cuts, eq. (56), and the line of the cut.
  void addCorner(const Corners& u, const Corners& p, const Corners& q, const Doubles& flux,
                 const Mask& is_cut, const Planes& planes) {
    const Doubles zero = {}, one = zero + 1.0;
    const Doubles lp = select(is_cut, u.depth / select(is_cut, u.depth - p.depth, one), zero);
    const Doubles lq = select(is_cut, u.depth / select(is_cut, u.depth - q.depth, one), zero);
    const Vectors to_p = lp * (p.place - u.place), to_q = lq * (q.place - u.place);
    const Doubles weight = (lp * lq) * flux;
    const Doubles by_depth = weight * u.depth;
    rows[kVolume] = rows[kVolume] + by_depth;
    rows[kDepth] = rows[kDepth] + by_depth * u.depth;
    addMoment(by_depth, (Doubles{} + 4.0) * u.place + to_p + to_q);
    addLine(u.place + to_p, u.place + to_q, u.depth > zero, is_cut, planes);
  }

  /// Moments of the waterplane; the water is to the left of the line seen from outside.
  void addLine(const Vectors& on_p, const Vectors& on_q, const Mask& is_tip_wet, const Mask& is_cut,
               const Planes& planes) {
    const Doubles ax = dot(planes.axis1, on_p), ay = dot(planes.axis2, on_p);
    const Doubles bx = dot(planes.axis1, on_q), by = dot(planes.axis2, on_q);
    const Doubles cross = ax * by - ay * bx;
    const Doubles k = select(is_cut, select(is_tip_wet, -cross, cross), Doubles{});
    const Doubles x = ax + bx, y = ay + by;
    rows[kArea] = rows[kArea] + k;
    rows[kFirst] = rows[kFirst] + k * x;
    rows[kFirst + 1] = rows[kFirst + 1] + k * y;
    rows[kSecond] = rows[kSecond] + k * (x * x + ax * ax + bx * bx);
    rows[kSecond + 1] = rows[kSecond + 1] + k * (x * y + ax * ay + bx * by);
    rows[kSecond + 2] = rows[kSecond + 2] + k * (y * y + ay * ay + by * by);
  }
};

/// kWidth triangles of a cut block.
inline void addTriangles(const HullBlock& block, int at, const Planes& planes, HullRows& sums) {
  const Doubles zero = {};
  const Corners a = planes.corners(load(block.corner[0], at));
  const Corners b = planes.corners(load(block.corner[1], at));
  const Corners c = planes.corners(load(block.corner[2], at));
  const Mask wet_a = a.depth > zero, wet_b = b.depth > zero, wet_c = c.depth > zero;
  if (!anyOf(wet_a | wet_b | wet_c)) return;
  const Mask most = (wet_a & wet_b) | (wet_b & wet_c) | (wet_c & wet_a);
  const Doubles flux = zero - dot(planes.normal, load(block.area_normal, at));
  sums.addWhole(a, b, c, select(most, flux, zero));
  const Mask is_cut = (wet_a | wet_b | wet_c) & ~(wet_a & wet_b & wet_c);
  if (!anyOf(is_cut)) return;
  const Mask alone_a = (wet_a ^ wet_b) & (wet_a ^ wet_c),
             alone_b = (wet_b ^ wet_a) & (wet_b ^ wet_c);
  const Corners u = select(alone_a, a, select(alone_b, b, c));
  const Corners p = select(alone_a, b, select(alone_b, c, a));
  const Corners q = select(alone_a, c, select(alone_b, a, b));
  sums.addCorner(u, p, q, select(most, -flux, flux), is_cut, planes);
}

/// What blocks there are in some groups.
struct Choice {
  double wet[kGroups][kLanes];  ///< 1: wholly
  int wet_groups[kGroups];      ///< with a wet block
  int wet_count = 0;
  int cut[kGroups * kLanes];
  int cut_count = 0;
};

inline void choose(const HullMoments* groups, int count, const Planes& planes, Choice& choice) {
  choice.wet_count = choice.cut_count = 0;
  const Doubles zero = {}, one = zero + 1.0;
  for (int group = 0; group < count; ++group) {
    double cuts[kLanes];
    bool has_wet = false;
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const Doubles depth = planes.corners(load(groups[group].centre, lane)).depth;
      const Doubles radius = load(groups[group].radius + lane);
      const Mask is_wet = depth > radius;
      store(choice.wet[group] + lane, select(is_wet, one, zero));
      store(cuts + lane, select(is_wet, zero, select(depth >= -radius, one, zero)));
      has_wet = has_wet || anyOf(is_wet);
    }
    if (has_wet) choice.wet_groups[choice.wet_count++] = group;
    for (int lane = 0; lane < kLanes; ++lane) {
      choice.cut[choice.cut_count] = group * kLanes + lane;
      choice.cut_count += cuts[lane] > 0;
    }
  }
}

inline void addCut(const HullBlock* blocks, const Choice& choice, const Planes& planes,
                   HullLanes& sums) {
  if (choice.cut_count == 0) return;
  for (int lane = 0; lane < kLanes; lane += kWidth) {
    HullRows rows(sums, lane);
    for (int i = 0; i < choice.cut_count; ++i)
      for (int at = lane; at < HullBlock::kTriangles; at += kLanes)
        addTriangles(blocks[choice.cut[i]], at, planes, rows);
    rows.storeTo(sums, lane);
  }
}

struct MomentLanes {
  double numbers[HullMoments::kNumbers][kLanes] = {};
};

inline void addWet(const HullMoments* groups, const Choice& choice, MomentLanes& sums) {
  if (choice.wet_count == 0) return;
  for (int number = 0; number < HullMoments::kNumbers; ++number)
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      Doubles sum = load(sums.numbers[number] + lane);
      for (int i = 0; i < choice.wet_count; ++i) {
        const int group = choice.wet_groups[i];
        sum = sum + load(choice.wet[group] + lane) * load(groups[group].moments[number] + lane);
      }
      store(sums.numbers[number] + lane, sum);
    }
}

inline double sumLanes(const double (&l)[kLanes]) {
  return ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
}

inline HullSums sumsOf(const HullLanes& lanes) {
  double r[kRows];
  for (int row = 0; row < kRows; ++row) r[row] = sumLanes(lanes.rows[row]);
  return {r[kVolume] / 3,
          r[kDepth] / 12,
          {r[kMoment] / 12, r[kMoment + 1] / 12, r[kMoment + 2] / 12},
          r[kArea] / 2,
          {r[kFirst] / 6, r[kFirst + 1] / 6},
          {r[kSecond] / 24, r[kSecond + 1] / 24, r[kSecond + 2] / 24}};
}

/// The wholly wet blocks, docs/theory.md eq. (57).
inline void addMoments(const MomentLanes& lanes, const HullPlane& plane, HullSums& sums) {
  double m[HullMoments::kNumbers];
  for (int number = 0; number < HullMoments::kNumbers; ++number)
    m[number] = sumLanes(lanes.numbers[number]);
  const double(&s)[3] = plane.normal;
  const double* const first = m + 3;    // M_jk
  const double* const second = m + 12;  // Q_jkl
  double sm[3], sq[6], sqs[3];          // s.M, s.Q, s.Q.s
  for (int k = 0; k < 3; ++k) sm[k] = s[0] * first[k] + s[1] * first[3 + k] + s[2] * first[6 + k];
  for (int k = 0; k < 6; ++k)
    sq[k] = s[0] * second[k] + s[1] * second[6 + k] + s[2] * second[12 + k];
  sqs[0] = s[0] * sq[0] + s[1] * sq[1] + s[2] * sq[2];
  sqs[1] = s[0] * sq[1] + s[1] * sq[3] + s[2] * sq[4];
  sqs[2] = s[0] * sq[2] + s[1] * sq[4] + s[2] * sq[5];
  const double h = plane.height;
  const double flux = s[0] * m[0] + s[1] * m[1] + s[2] * m[2];
  const double sms = s[0] * sm[0] + s[1] * sm[1] + s[2] * sm[2];
  sums.volume += sms - h * flux;
  for (int k = 0; k < 3; ++k) sums.moment[k] += sqs[k] - h * sm[k];
  sums.depth += h * sms - 0.5 * (h * h * flux + (s[0] * sqs[0] + s[1] * sqs[1] + s[2] * sqs[2]));
}

}  // namespace

HullSums AMBIENT_KERNEL(const HullBlocks& hull, const HullPlane& plane) noexcept {
  const Planes planes(plane);
  HullLanes cut;
  MomentLanes wet;
  Choice choice;
  const std::size_t groups = (hull.count + kLanes - 1) / kLanes;
  for (std::size_t begin = 0; begin < groups; begin += kGroups) {
    const std::size_t left = groups - begin;
    choose(hull.moments + begin, left < kGroups ? static_cast<int>(left) : kGroups, planes, choice);
    addCut(hull.blocks + begin * kLanes, choice, planes, cut);
    addWet(hull.moments + begin, choice, wet);
  }
  HullSums sums = sumsOf(cut);
  addMoments(wet, plane, sums);
  return sums;
}

}  // namespace ambient
