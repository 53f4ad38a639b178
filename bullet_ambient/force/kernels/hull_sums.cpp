#include "bullet_ambient/force/kernels/hull_sums.h"

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/base/lanes.h"
#include "bullet_ambient/fluid_body/blocks.h"

// Sums over the wet parts of triangles, docs/theory.md eq. (55), (56) and (58), one triangle per
// lane. Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the kernel.

namespace ambient {

namespace {

constexpr int kLanes = 8;
static_assert(HullBlock::kTriangles == kLanes, "a block has one triangle per lane");

using Vectors = VectorsOf<Doubles>;

/// HullPlane in all lanes. `size`: absolute values of the normal's components.
struct Planes {
  Vectors normal, axis1, axis2, size;
  Doubles height;

  explicit Planes(const HullPlane& plane)
      : normal(inAllLanes<Doubles>(plane.normal)),
        axis1(inAllLanes<Doubles>(plane.axes[0])),
        axis2(inAllLanes<Doubles>(plane.axes[1])),
        size({larger(normal.x), larger(normal.y), larger(normal.z)}),
        height(Doubles{} + plane.height) {}
  Doubles depth(const Vectors& place) const { return height - dot(normal, place); }
  /// Returns coordinates along e_1 and e_2, and the depth as z.
  Vectors seen(const Vectors& place, const Doubles& depth) const {
    return {dot(axis1, place), dot(axis2, place), depth};
  }

 private:
  static Doubles larger(const Doubles& a) { return a > -a ? a : -a; }
};

/// Rows of partial sums, which are multiples of HullSums: 3 V, 12 S along e_1 and e_2, 24 W; 2 A_w,
/// 6 P_1, 24 P_2.
enum Row {
  kVolume,
  kMoment,
  kDepth = kMoment + 2,
  kArea,
  kFirst,
  kSecond = kFirst + 2,
  kRows = 10
};
/// Masks of wet corners; depths za, zb, zc of the corners of triangles.
struct WetCorners {
  Mask a, b, c;

  WetCorners(const Doubles& za, const Doubles& zb, const Doubles& zc)
      : a(za > Doubles{}), b(zb > Doubles{}), c(zc > Doubles{}) {}
  Mask any() const { return a | b | c; }
  Mask all() const { return a & b & c; }
  Mask most() const { return (a & b) | (b & c) | (c & a); }
};

/// Partial sums, one per lane.
struct HullRows {
  Doubles rows[kRows] = {};

  /// Adds the triangles of a block in the lanes from `lane`; dry ones add nothing.
  void addTriangles(const HullBlock& block, int lane, const Planes& planes) {
    const Doubles zero = {};
    const Vectors places[3] = {load(block.corner[0], lane), load(block.corner[1], lane),
                               load(block.corner[2], lane)};
    const Doubles za = planes.depth(places[0]), zb = planes.depth(places[1]),
                  zc = planes.depth(places[2]);
    const WetCorners wet(za, zb, zc);
    if (!anyOf(wet.any())) return;
    const Vectors twice_area = cross(places[1] - places[0], places[2] - places[0]);
    const Doubles flux = -dot(planes.normal, twice_area) / 2;
    const Vectors a = planes.seen(places[0], za), b = planes.seen(places[1], zb),
                  c = planes.seen(places[2], zc);
    const Mask most = wet.most();
    if (anyOf(most)) addWhole(a, b, c, most ? flux : zero);
    const Mask is_cut = wet.any() & ~wet.all();
    if (!anyOf(is_cut)) return;
    const Mask alone_a = (wet.a ^ wet.b) & (wet.a ^ wet.c),
               alone_b = (wet.b ^ wet.a) & (wet.b ^ wet.c);
    const Vectors u = select(alone_a, a, select(alone_b, b, c));
    const Vectors p = select(alone_a, b, select(alone_b, c, a));
    const Vectors q = select(alone_a, c, select(alone_b, a, b));
    addCorner(u, p, q, most ? -flux : flux, is_cut);
  }

 private:
  /// Adds whole triangles, docs/theory.md eq. (55).
  void addWhole(const Vectors& a, const Vectors& b, const Vectors& c, const Doubles& flux) {
    const Vectors sum = a + b + c;
    addMoments(flux, a.z * a + b.z * b + c.z * c + sum.z * sum);
    rows[kVolume] = rows[kVolume] + flux * sum.z;
  }
  void addMoments(const Doubles& flux, const Vectors& of_depth) {
    rows[kMoment] = rows[kMoment] + flux * of_depth.x;
    rows[kMoment + 1] = rows[kMoment + 1] + flux * of_depth.y;
    rows[kDepth] = rows[kDepth] + flux * of_depth.z;
  }

  /// Adds the corner triangle at u of triangles that the plane cuts, eq. (56), and the line of cut.
  void addCorner(const Vectors& u, const Vectors& p, const Vectors& q, const Doubles& flux,
                 const Mask& is_cut) {
    const Doubles zero = {}, one = zero + 1.0;
    // lp = u.z / (u.z - p.z) and lq = u.z / (u.z - q.z): places of the cut on the edges from u. One
    // division serves both.
    const Doubles to_p = u.z - p.z, to_q = u.z - q.z, product = to_p * to_q;
    const Doubles per = is_cut ? u.z / (product > zero ? product : one) : zero;
    const Doubles lp = per * to_q, lq = per * to_p;
    const Doubles px = u.x + lp * (p.x - u.x), py = u.y + lp * (p.y - u.y);
    const Doubles qx = u.x + lq * (q.x - u.x), qy = u.y + lq * (q.y - u.y);
    const Doubles by_depth = (lp * lq) * flux * u.z;
    rows[kVolume] = rows[kVolume] + by_depth;
    addMoments(by_depth, {2 * u.x + px + qx, 2 * u.y + py + qy, 2 * u.z});
    const Doubles cross = px * qy - py * qx;
    addLine(px, py, qx, qy, is_cut ? (u.z > zero ? -cross : cross) : zero);
  }

  /// Adds the segment from a to b with k = s.(a x b) to the moments of the waterplane, eq. (58).
  void addLine(const Doubles& ax, const Doubles& ay, const Doubles& bx, const Doubles& by,
               const Doubles& k) {
    const Doubles x = ax + bx, y = ay + by;
    rows[kArea] = rows[kArea] + k;
    rows[kFirst] = rows[kFirst] + k * x;
    rows[kFirst + 1] = rows[kFirst + 1] + k * y;
    rows[kSecond] = rows[kSecond] + k * (x * x + ax * ax + bx * bx);
    rows[kSecond + 1] = rows[kSecond + 1] + k * (x * y + ax * ay + bx * by);
    rows[kSecond + 2] = rows[kSecond + 2] + k * (y * y + ay * ay + by * by);
  }
};

constexpr int kGroups = 32;  ///< number of groups of eight blocks per pass
static_assert(HullBoxes::kBlocks == kLanes, "a group has one block per lane");

/// Blocks of one pass, sorted into wholly wet, cut and dry ones.
struct Choice {
  int wet[kGroups * kLanes], cut[kGroups * kLanes];  ///< indices of wholly wet and of cut blocks
  int wet_count = 0, cut_count = 0;
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

/// Sorts `count` blocks by their bounding boxes. Blocks whose box meets the plane are sorted by
/// their corners.
inline void choose(const HullBoxes* boxes, int count, const HullBlock* blocks, const Planes& planes,
                   Choice& choice) {
  choice.wet_count = choice.cut_count = 0;
  const Doubles zero = {}, one = zero + 1.0;
  for (int first = 0; first < count; first += kLanes) {
    double above_box[kLanes], meets_box[kLanes];
    const HullBoxes& group = boxes[first / kLanes];
    for (int lane = 0; lane < kLanes; lane += kWidth) {
      const Doubles depth = planes.depth(load(group.centre, lane));
      const Doubles reach = dot(planes.size, load(group.half, lane));
      store(above_box + lane, depth > reach ? one : zero);
      store(meets_box + lane, depth >= -reach ? one : zero);
    }
    for (int lane = 0; lane < kLanes && first + lane < count; ++lane) {
      if (!(meets_box[lane] > 0)) continue;
      const int block = first + lane;
      const Side side = above_box[lane] > 0 ? Side::kWet : sideOf(blocks[block], planes);
      if (side == Side::kWet) choice.wet[choice.wet_count++] = block;
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

/// Rows of sums over wholly wet blocks: s.N, s.M, s.Q of eq. (57).
enum WetRow { kFlux, kFluxMoment, kFluxSecond = kFluxMoment + 3, kWetRows = 10 };
static_assert(kWetRows == HullMoments::kNumbers, "each number has a row");

/// Partial sums, lane by lane.
struct WetRows {
  double lanes[kLanes][kWetRows] = {};

  /// Adds the moments of wholly wet blocks.
  void add(const HullMoments* moments, const Choice& choice, const double (&s)[3]) {
    for (int i = 0; i < choice.wet_count; ++i) {
      const double(&m)[3][kWetRows] = moments[choice.wet[i]].of;
      double(&sums)[kWetRows] = lanes[choice.wet[i] % kLanes];
      for (int row = 0; row < kWetRows; ++row)
        sums[row] += s[0] * m[0][row] + s[1] * m[1][row] + s[2] * m[2][row];
    }
  }
  double sumOf(int row) const {
    double of_row[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) of_row[lane] = lanes[lane][row];
    return sumLanes(of_row);
  }
};

/// Adds the lanes of each row.
inline void sumRows(const HullRows (&parts)[kLanes / kWidth], double (&sums)[kRows]) {
  for (int row = 0; row < kRows; ++row) {
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
  WetRows wet;
  Choice choice;
  constexpr std::size_t kPass = kGroups * kLanes;
  for (std::size_t begin = 0; begin < hull.count; begin += kPass) {
    const std::size_t left = hull.count - begin;
    const int count = static_cast<int>(left < kPass ? left : kPass);
    choose(hull.boxes + begin / kLanes, count, hull.blocks + begin, planes, choice);
    addCut(hull.blocks + begin, choice, planes, cut);
    wet.add(hull.moments + begin, choice, plane.normal);
  }
  double of_cut[kRows], of_wet[kWetRows];
  sumRows(cut, of_cut);
  for (int row = 0; row < kWetRows; ++row) of_wet[row] = wet.sumOf(row);
  HullSums sums = sumsOf(of_cut);
  addWetTo(sums, of_wet, plane);
  return sums;
}

inline double absolute(double a) { return a < 0 ? -a : a; }

/// Returns the extent along s. Skips blocks whose bounding box lies within the extent found so far.
HullExtent hullExtent(const HullCorners& corners, const double (&s)[3]) noexcept {
  const Vectors normal = inAllLanes<Doubles>(s);
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

const HullKernel AMBIENT_KERNEL(kHullKernel){sumHull, hullExtent};

}  // namespace ambient
