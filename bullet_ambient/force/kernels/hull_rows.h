#pragma once

#include "bullet_ambient/fluid_body/packed/hull_block.h"
#include "bullet_ambient/force/kernels/double_lanes.h"
#include "bullet_ambient/force/kernels/hull_plane.h"

// Sums over the wet parts of triangles, docs/theory.md eq. (55), (56) and (58), one triangle per
// lane. For sources that are compiled once per instruction set, see double_lanes.h.

namespace ambient {
namespace {

constexpr int kLanes = 8;
static_assert(HullBlock::kTriangles == kLanes, "a block has one triangle per lane");

inline Doubles broadcast(double value) { return Doubles{} + value; }
inline Vectors broadcast(const double (&v)[3]) {
  return {broadcast(v[0]), broadcast(v[1]), broadcast(v[2])};
}
template <int kColumns>
inline Vectors load(const double (&columns)[3][kColumns], int at) {
  return {load(columns[0] + at), load(columns[1] + at), load(columns[2] + at)};
}
inline Doubles select(const Mask& mask, const Doubles& a, const Doubles& b) { return mask ? a : b; }
inline Vectors select(const Mask& mask, const Vectors& a, const Vectors& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

/// HullPlane in all lanes. `size`: absolute values of the normal's components.
struct Planes {
  Vectors normal, axis1, axis2, size;
  Doubles height;

  explicit Planes(const HullPlane& plane)
      : normal(broadcast(plane.normal)),
        axis1(broadcast(plane.axes[0])),
        axis2(broadcast(plane.axes[1])),
        size({larger(normal.x), larger(normal.y), larger(normal.z)}),
        height(broadcast(plane.height)) {}
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
    const Doubles flux = -dot(planes.normal, load(block.area_normal, lane));
    const Vectors a = planes.seen(places[0], za), b = planes.seen(places[1], zb),
                  c = planes.seen(places[2], zc);
    const Mask most = wet.most();
    if (anyOf(most)) addWhole(a, b, c, select(most, flux, zero));
    const Mask is_cut = wet.any() & ~wet.all();
    if (!anyOf(is_cut)) return;
    const Mask alone_a = (wet.a ^ wet.b) & (wet.a ^ wet.c),
               alone_b = (wet.b ^ wet.a) & (wet.b ^ wet.c);
    const Vectors u = select(alone_a, a, select(alone_b, b, c));
    const Vectors p = select(alone_a, b, select(alone_b, c, a));
    const Vectors q = select(alone_a, c, select(alone_b, a, b));
    addCorner(u, p, q, select(most, -flux, flux), is_cut);
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
    const Doubles per = select(is_cut, u.z / select(product > zero, product, one), zero);
    const Doubles lp = per * to_q, lq = per * to_p;
    const Doubles px = u.x + lp * (p.x - u.x), py = u.y + lp * (p.y - u.y);
    const Doubles qx = u.x + lq * (q.x - u.x), qy = u.y + lq * (q.y - u.y);
    const Doubles by_depth = (lp * lq) * flux * u.z;
    rows[kVolume] = rows[kVolume] + by_depth;
    addMoments(by_depth, {2 * u.x + px + qx, 2 * u.y + py + qy, 2 * u.z});
    const Doubles cross = px * qy - py * qx;
    addLine(px, py, qx, qy, select(is_cut, select(u.z > zero, -cross, cross), zero));
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

}  // namespace
}  // namespace ambient
