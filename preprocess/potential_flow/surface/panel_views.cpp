#include "preprocess/potential_flow/surface/panel_views.h"

#include "bullet_ambient/base/lanes.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the kernel.

namespace ambient {
namespace {

using Bits = std::uint64_t __attribute__((vector_size(kRegister)));

/// Sums c[0] + c[1] x + ... by Horner's rule.
template <int kCount>
inline Doubles polynomial(const double (&c)[kCount], const Doubles& x) {
  Doubles sum = Doubles{} + c[kCount - 1];
  for (int i = kCount - 2; i >= 0; --i) sum = sum * x + c[i];
  return sum;
}

/// Natural logarithm of positive normal numbers, within 2 ulp above 1.5; absolute error 2e-16
/// below.
inline Doubles logOf(const Doubles& x) {
  constexpr double kLog2 = 0x1.62e42fefa2p-1, kLog2Low = 0x1.9ef35793c7673p-41;
  constexpr double kOddInverses[] = {1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11,
                                     1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21};
  const Bits bits = (Bits)x;
  // x = 2^power m, m in (0.7, 1.42). A power in the last bits of 2^52 is a double of that number.
  Doubles power = (Doubles)(bits >> 52 | 0x4330000000000000) - (0x1p52 + 1023);
  Doubles m = (Doubles)((bits & 0xfffffffffffff) | 0x3ff0000000000000);
  const Mask is_large = m > 1.4142135623730951;
  m = is_large ? 0.5 * m : m;
  power = is_large ? power + 1.0 : power;
  const Doubles s = (m - 1.0) / (m + 1.0), square = s * s;  // log(m) = 2 artanh(s)
  const Doubles rest = 2.0 * s * square * polynomial(kOddInverses, square);
  return power * kLog2 + (2.0 * s + (rest + power * kLog2Low));
}

/// Angle of (x, y), in [-pi, pi], with an absolute error of 4e-16; the sign of a zero y counts.
inline Doubles angleOf(const Doubles& y, const Doubles& x) {
  constexpr double kHalfTurn = 0x1.921fb54442d18p+1;
  constexpr double kSeries[] = {-1.0 / 3, 1.0 / 5,   -1.0 / 7, 1.0 / 9,   -1.0 / 11,
                                1.0 / 13, -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21};
  const Doubles zero = {};
  const Bits sign = (Bits{} + 0x8000000000000000) & (Bits)y;
  const Doubles across = y < zero ? -y : y, along = x < zero ? -x : x;
  const Mask is_steep = across > along;
  const Doubles low = is_steep ? along : across, high = is_steep ? across : along;
  // tan(a - b) = (tan(a) - tan(b)) / (1 + tan(a) tan(b)), b = 0, pi/8 or pi/4.
  const Mask above_first = low > 0.19891236737965801 * high;   // tan(pi/16)
  const Mask above_second = low > 0.66817863791929892 * high;  // tan(3 pi/16)
  const Doubles none = {}, first = none + 0.41421356237309505, one = none + 1.0;
  const Doubles tangent = above_second ? one : above_first ? first : none;
  const Doubles known = above_second  ? none + kHalfTurn / 4
                        : above_first ? none + kHalfTurn / 8
                                      : none;
  const Doubles below = high + tangent * low;
  const Doubles t = (low - tangent * high) / (below > zero ? below : one), square = t * t;
  Doubles angle = known + (t + t * square * polynomial(kSeries, square));
  angle = is_steep ? kHalfTurn / 2 - angle : angle;
  angle = x < zero ? kHalfTurn - angle : angle;
  return (Doubles)((Bits)angle | sign);
}

}  // namespace

void AMBIENT_KERNEL(viewPanel)(const PanelNumbers& panel, const PanelPoints& points, int count,
                               PanelViews& views) {
  using Vectors = VectorsOf<Doubles>;
  const Doubles zero = {}, one = zero + 1.0;
  const Vectors normal = inAllLanes<Doubles>(panel.normal);
  for (int lane = 0; lane < count; lane += kWidth) {
    const Vectors at = load(points.at, lane);
    Vectors d[3];
    Doubles r[3];
    for (int k = 0; k < 3; ++k) {
      d[k] = inAllLanes<Doubles>(panel.corner[k]) - at;
      r[k] = squareRoot(dot(d[k], d[k]));
    }
    for (int k = 0; k < 3; ++k) {
      const Doubles sum = r[k] + r[(k + 1) % 3];
      const Doubles gap = sum - panel.edge_length[k];
      // On the edge itself the logarithm is infinite, but always multiplied by a distance of 0.
      const Mask is_off = gap > zero;
      const Doubles ratio = is_off ? (sum + panel.edge_length[k]) / (is_off ? gap : one) : one;
      store(views.edge_potential[k] + lane, logOf(ratio));
      store(views.edge_distance[k] + lane, dot(d[k], inAllLanes<Doubles>(panel.edge_normal[k])));
    }
    const Doubles height = -dot(d[0], normal);
    const Doubles denominator = r[0] * r[1] * r[2] + dot(d[0], d[1]) * r[2] +
                                dot(d[1], d[2]) * r[0] + dot(d[2], d[0]) * r[1];
    store(views.height + lane, height);
    // van Oosterom and Strackee 1983, with the triple product -d0.(d1 x d2) = 2 area height.
    store(views.solid_angle + lane, 2.0 * angleOf(2 * panel.area * height, denominator));
  }
}

}  // namespace ambient
