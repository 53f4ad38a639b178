#include "bullet_ambient/force/kernels/hull_sums.h"

#include <initializer_list>

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
    const Doubles ratio = is_cut ? u.z / (product > zero ? product : one) : zero;
    const Doubles lp = ratio * to_q, lq = ratio * to_p;
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
/// their corners; without `kByCorners` they count as cut, as most are of a small part of a hull.
template <bool kByCorners>
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
      const Side side = above_box[lane] > 0 ? Side::kWet
                        : kByCorners        ? sideOf(blocks[block], planes)
                                            : Side::kCut;
      if (side == Side::kWet) choice.wet[choice.wet_count++] = block;
      if (side == Side::kCut) choice.cut[choice.cut_count++] = block;
    }
  }
}

/// Adds the triangles of cut blocks.
inline void addCut(const HullBlock* blocks, const Choice& choice, const Planes& planes,
                   HullRows (&sums)[kLanes / kWidth]) {
  if (choice.cut_count == 0) return;
  for (int part = 0; part < kLanes / kWidth; ++part) {
    HullRows rows = sums[part];
    for (int i = 0; i < choice.cut_count; ++i)
      rows.addTriangles(blocks[choice.cut[i]], part * kWidth, planes);
    sums[part] = rows;
  }
}

/// Rows of sums over wholly wet blocks: s.N, s.M, s.Q of eq. (57).
enum { kFlux, kFluxMoment, kFluxSecond = kFluxMoment + 3, kWetRows = 10 };
static_assert(kWetRows == HullMoments::kNumbers, "each number has a row");

/// Adds the sums over wholly wet triangles of these moments to rows.
inline void addMoments(const HullMoments& moments, const double (&s)[3], double (&rows)[kWetRows]) {
  const double(&m)[3][kWetRows] = moments.of;
  for (int row = 0; row < kWetRows; ++row)
    rows[row] += s[0] * m[0][row] + s[1] * m[1][row] + s[2] * m[2][row];
}

/// Partial sums, lane by lane.
struct WetRows {
  double lanes[kLanes][kWetRows] = {};
  bool is_any = false;

  /// Adds the moments of wholly wet blocks.
  void add(const HullMoments* moments, const Choice& choice, const double (&s)[3]) {
    is_any = is_any || choice.wet_count > 0;
    for (int i = 0; i < choice.wet_count; ++i)
      addMoments(moments[choice.wet[i]], s, lanes[choice.wet[i] % kLanes]);
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

/// Calls visit(moments, choice) for the blocks, pass by pass, and adds those that are cut.
template <bool kByCorners, class Visit>
inline void forPasses(const HullBlocks& hull, const Planes& planes,
                      HullRows (&cut)[kLanes / kWidth], const Visit& visit) {
  Choice choice;
  constexpr std::size_t kPass = kGroups * kLanes;
  for (std::size_t begin = 0; begin < hull.count; begin += kPass) {
    const std::size_t left = hull.count - begin;
    const int count = static_cast<int>(left < kPass ? left : kPass);
    choose<kByCorners>(hull.boxes + begin / kLanes, count, hull.blocks + begin, planes, choice);
    addCut(hull.blocks + begin, choice, planes, cut);
    visit(hull.moments + begin, choice);
  }
}

inline double absolute(double a) { return a < 0 ? -a : a; }

/// Returns the side of all triangles that are kept, by their bounding box.
inline Side sideOf(const HullWhole& whole, const HullPlane& plane) {
  const double depth = plane.height - dot(plane.normal, whole.centre);
  double reach = 0;
  for (int axis = 0; axis < 3; ++axis) reach += absolute(plane.normal[axis]) * whole.half[axis];
  if (depth > reach) return Side::kWet;
  return depth >= -reach ? Side::kCut : Side::kDry;
}

/// A plane as the part of a hull that is kept sees it from one image after the other, and sums over
/// the wholly wet triangles of the images in its frame.
struct SeenPlane {
  HullPlane plane;
  double rows[kWetRows] = {};

  /// Turns to the next image; after the last one plane and sums are those of the body.
  void turn(const HullSymmetry& symmetry) {
    constexpr int kAt[3][3] = {{4, 5, 6}, {5, 7, 8}, {6, 8, 9}};  // rows of Q
    static_assert(kAt[0][0] == kFluxSecond && kAt[2][2] == kWetRows - 1);
    const int axis = symmetry.axis, first = (axis + 1) % 3, second = (axis + 2) % 3;
    const auto turnBy = [](double& x, double& y) {
      const double before = x;
      x = y;
      y = -before;
    };
    for (double* v : {plane.normal, plane.axes[0], plane.axes[1], rows + kFluxMoment})
      turnBy(v[first], v[second]);
    turnBy(rows[kAt[axis][first]], rows[kAt[axis][second]]);
    turnBy(rows[kAt[first][first]], rows[kAt[second][second]]);
    rows[kAt[second][second]] = -rows[kAt[second][second]];
    rows[kAt[first][second]] = -rows[kAt[first][second]];
  }
};

/// Sums over the images of the part of a hull that is kept, one after the other.
HullSums sumImages(const HullBlocks& hull, const HullPlane& plane) noexcept {
  HullRows cut[kLanes / kWidth];
  SeenPlane seen{plane};
  for (int image = 0; image < hull.symmetry.images(); ++image, seen.turn(hull.symmetry)) {
    const Side side = sideOf(*hull.whole, seen.plane);
    if (side == Side::kWet) addMoments(hull.whole->moments, seen.plane.normal, seen.rows);
    if (side != Side::kCut) continue;
    forPasses<false>(hull, Planes(seen.plane), cut,
                     [&](const HullMoments* moments, const Choice& choice) {
                       for (int i = 0; i < choice.wet_count; ++i)
                         addMoments(moments[choice.wet[i]], seen.plane.normal, seen.rows);
                     });
  }
  double of_cut[kRows];
  sumRows(cut, of_cut);
  HullSums sums = sumsOf(of_cut);
  addWetTo(sums, seen.rows, plane);
  return sums;
}

HullSums sumHull(const HullBlocks& hull, const HullPlane& plane) noexcept {
  if (hull.whole) return sumImages(hull, plane);
  HullRows cut[kLanes / kWidth];
  WetRows wet;
  forPasses<true>(hull, Planes(plane), cut, [&](const HullMoments* moments, const Choice& choice) {
    wet.add(moments, choice, plane.normal);
  });
  double of_cut[kRows], of_wet[kWetRows];
  sumRows(cut, of_cut);
  HullSums sums = sumsOf(of_cut);
  if (!wet.is_any) return sums;
  for (int row = 0; row < kWetRows; ++row) of_wet[row] = wet.sumOf(row);
  addWetTo(sums, of_wet, plane);
  return sums;
}

/// Widens an extent by that of points; the first ones make it.
inline void widen(HullExtent& extent, const Doubles& low, const Doubles& high, bool are_first) {
  double lows[kWidth], highs[kWidth];
  store(lows, low);
  store(highs, high);
  if (are_first) extent = {lows[0], highs[0]};
  for (int lane = 0; lane < kWidth; ++lane) {
    if (lows[lane] < extent.low) extent.low = lows[lane];
    if (highs[lane] > extent.high) extent.high = highs[lane];
  }
}

/// Returns the extent along s of the images of corners that are kept. Skips blocks as hullExtent().
HullExtent extentOfImages(const HullCorners& corners, const double (&s)[3]) noexcept {
  const int axis = corners.symmetry.axis, first = (axis + 1) % 3, second = (axis + 2) % 3;
  const Doubles zero = {}, to_x = zero + s[first], to_y = zero + s[second];
  const double up = s[axis], across = absolute(s[first]) + absolute(s[second]);
  HullExtent extent{};
  for (std::size_t i = 0; i < corners.count; ++i) {
    const HullPoints& block = corners.blocks[i];
    const auto farthest = [&](int of) { return absolute(block.centre[of]) + block.half[of]; };
    const double way = farthest(first) > farthest(second) ? farthest(first) : farthest(second);
    const double middle = up * block.centre[axis];
    const double reach = absolute(up) * block.half[axis] + across * way;
    if (i > 0 && middle - reach >= extent.low && middle + reach <= extent.high) continue;
    Doubles low = zero, high = zero;
    for (int at = 0; at < HullPoints::kPoints; at += kWidth) {
      const Doubles x = load(block.place[first] + at), y = load(block.place[second] + at);
      const Doubles along = to_x * x + to_y * y, turned = to_y * x - to_x * y;
      const Doubles one = along > zero ? along : -along, other = turned > zero ? turned : -turned;
      const Doubles aside = one > other ? one : other, z = up * load(block.place[axis] + at);
      const Doubles lowest = z - aside, highest = z + aside;
      low = at == 0 ? lowest : lowest < low ? lowest : low;
      high = at == 0 ? highest : highest > high ? highest : high;
    }
    widen(extent, low, high, i == 0);
  }
  return extent;
}

/// Returns the extent along s. Skips blocks whose bounding box lies within the extent found so far.
HullExtent hullExtent(const HullCorners& corners, const double (&s)[3]) noexcept {
  if (corners.symmetry.axis >= 0) return extentOfImages(corners, s);
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
    widen(extent, low, high, i == 0);
  }
  return extent;
}

}  // namespace

const HullKernel AMBIENT_KERNEL(kHullKernel){sumHull, hullExtent};

}  // namespace ambient
