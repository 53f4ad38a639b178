#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/elementary_numbers.h"

namespace ambient::portable {
namespace {

constexpr double kQuarterTurn = 0x1.921fb54442d18p+0, kQuarterTurnLow = 0x1.1a62633145c07p-54;

/// An angle minus `quarters` quarter turns: `rest`, within [-pi/4, pi/4] [rad].
struct ReducedAngle {
  Sum rest;
  unsigned quarters = 0;
};

/// Reduces angles below 2^20; multiples of the parts of pi/2 are exact (Cody and Waite).
ReducedAngle reduceSmall(double angle) {
  constexpr double kParts[] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2ep-69,
                               0x1.b839a252049c1p-104};
  constexpr double kQuartersPerAngle = 0x1.45f306dc9c883p-1;
  const double quarters = nearest(angle * kQuartersPerAngle);
  Sum rest{angle - quarters * kParts[0], 0};
  for (int i = 1; i < 4; ++i) {
    const Sum next = exactSum(rest.high, -quarters * kParts[i]);
    rest = exactSum(next.high, next.low + rest.low);
  }
  return {rest, static_cast<unsigned>(static_cast<int>(quarters))};
}

__extension__ typedef unsigned __int128 Wide;

/// Reads 192 bits from bit `first` of 64 zeros followed by 2/pi: three words, highest first.
void readTwoOverPi(int first, std::uint64_t (&words)[3]) {
  static constexpr std::uint64_t kBits[] = {0,
                                            0xa2f9836e4e441529,
                                            0xfc2757d1f534ddc0,
                                            0xdb6295993c439041,
                                            0xfe5163abdebbc561,
                                            0xb7246e3a424dd2e0,
                                            0x06492eea09d1921c,
                                            0xfe1deb1cb129a73e,
                                            0xe88235f52ebb4484,
                                            0xe99c7026b45f7e41,
                                            0x3991d639835339f4,
                                            0x9c845f8bbdf9283b,
                                            0x1ff897ffde05980f,
                                            0xef2f118b5a0a6d1f,
                                            0x6d367ecf27cb09b7,
                                            0x4f463f669e5fea2d,
                                            0x7527bac7ebe5f17b,
                                            0x3d0739f78a5292ea,
                                            0x6bfb5fb11f8d5d08,
                                            0x56033046fc7b6bab};
  const int word = first / 64, shift = first % 64;
  for (int i = 0; i < 3; ++i) {
    words[i] = kBits[word + i] << shift;
    if (shift > 0) words[i] |= kBits[word + i + 1] >> (64 - shift);
  }
}

/// Reduces angles of 2^20 and more: multiplies by the bits of 2/pi that matter (Payne, Hanek).
ReducedAngle reduceLarge(double angle) {
  const std::uint64_t mantissa = (bitsOf(angle) & 0xfffffffffffff) | 0x10000000000000;
  std::uint64_t words[3];
  readTwoOverPi(exponentOf(angle) - 52 + 62, words);  // bits of less than four quarter turns
  const Wide low = static_cast<Wide>(mantissa) * words[2];
  const Wide middle = static_cast<Wide>(mantissa) * words[1] + (low >> 64);
  const Wide turns = (static_cast<Wide>(mantissa * words[0]) << 64) + middle;  // modulo 4: 2^128
  const unsigned quarters = static_cast<unsigned>(turns >> 126);
  const bool is_above_half = (turns >> 125 & 1) != 0;
  const Wide fraction = turns << 2;  // fraction of a quarter turn, unit 2^-128
  const Wide size = is_above_half ? -fraction : fraction;
  const double sign = is_above_half ? -0x1p-128 : 0x1p-128;
  const Sum share = exactOrderedSum(
      static_cast<double>(static_cast<std::uint64_t>(size >> 75)) * 0x1p75 * sign,
      static_cast<double>(static_cast<std::uint64_t>(size >> 11 & 0xffffffffffffffff)) * 0x1p11 *
          sign);
  return {share * Sum{kQuarterTurn, kQuarterTurnLow}, quarters + (is_above_half ? 1 : 0)};
}

/// Reduces |angle|; the rest is NaN if the angle is not finite.
ReducedAngle reduce(double angle) {
  const double size = std::fabs(angle);
  if (size <= kQuarterTurn / 2) return {{size, 0}, 0};
  if (size < 0x1p20) return reduceSmall(size);
  if (!(size < kInfinity)) return {{kNotANumber, 0}, 0};
  return reduceLarge(size);
}

double sineOf(const Sum& a) {
  static constexpr double kSeries[] = {-1.0 / 6,
                                       1.0 / 120,
                                       -1.0 / 5040,
                                       1.0 / 362880,
                                       -1.0 / 39916800.0,
                                       1.0 / 6227020800.0,
                                       -1.0 / 1307674368000.0,
                                       1.0 / 355687428096000.0};
  const double square = a.high * a.high;
  return a.high + (a.high * square * polynomial(kSeries, square) + a.low * (1 - square / 2));
}

double cosineOf(const Sum& a) {
  static constexpr double kSeries[] = {1.0 / 24,
                                       -1.0 / 720,
                                       1.0 / 40320,
                                       -1.0 / 3628800,
                                       1.0 / 479001600.0,
                                       -1.0 / 87178291200.0,
                                       1.0 / 20922789888000.0,
                                       -1.0 / 6402373705728000.0};
  const double square = a.high * a.high, half = square / 2;
  const Sum lead = exactOrderedSum(1, -half);
  return lead.high + (lead.low + (square * square * polynomial(kSeries, square) - a.high * a.low));
}

/// atan(y / x) for 0 <= y <= x, x > 0, both finite.
Sum arcTangent(double y, double x) {
  static constexpr Sum kEighths[] = {{0, 0},  // atan(i / 8)
                                     {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                     {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                     {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                     {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                     {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                     {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                     {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                     {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
  static constexpr double kSeries[] = {-1.0 / 3,  1.0 / 5,  -1.0 / 7, 1.0 / 9,
                                       -1.0 / 11, 1.0 / 13, -1.0 / 15};
  const double quotient = y / x;
  if (quotient < 0x1p-30) return {quotient, 0};  // cube of the quotient is below rounding
  // Scales y and x to between 2^-30 and 2.
  const double scale = powerOfTwo(-std::min(exponentOf(x), 1022));
  y *= scale;
  x *= scale;
  // tan(a - b) = (tan(a) - tan(b)) / (1 + tan(a) tan(b)), b = atan(i / 8).
  const double eighths = nearest(8 * quotient);
  const Sum above = exactProduct(eighths / 8, x), beside = exactProduct(eighths / 8, y);
  const double numerator = (y - above.high) - above.low;
  Sum denominator = exactSum(x, beside.high);
  denominator.low += beside.low;
  const double t = numerator / denominator.high;
  const Sum back = exactProduct(t, denominator.high);
  const double t_low =
      ((numerator - back.high) - back.low - t * denominator.low) / denominator.high;
  const double square = t * t;
  const Sum& known = kEighths[static_cast<int>(eighths)];
  const double small = t * square * polynomial(kSeries, square) + (t_low + known.low);
  const Sum sum = exactSum(known.high, t);
  return exactOrderedSum(sum.high, sum.low + small);
}

}  // namespace

double sin(double angle) noexcept {
  if (std::fabs(angle) < 0x1p-27) return angle;
  const ReducedAngle reduced = reduce(angle);
  double sine = reduced.quarters % 2 == 0 ? sineOf(reduced.rest) : cosineOf(reduced.rest);
  if (reduced.quarters % 4 >= 2) sine = -sine;
  return angle < 0 ? -sine : sine;
}

double cos(double angle) noexcept {
  const ReducedAngle reduced = reduce(angle);
  const double cosine = reduced.quarters % 2 == 0 ? cosineOf(reduced.rest) : sineOf(reduced.rest);
  return (reduced.quarters + 1) % 4 >= 2 ? -cosine : cosine;
}

SineCosine sineAndCosine(double angle) noexcept {
  if (std::fabs(angle) < 0x1p-27) return {angle, 1};
  const ReducedAngle reduced = reduce(angle);
  double sine = sineOf(reduced.rest), cosine = cosineOf(reduced.rest);
  if (reduced.quarters % 2 != 0) std::swap(sine, cosine);
  if (reduced.quarters % 4 >= 2) sine = -sine;
  if ((reduced.quarters + 1) % 4 >= 2) cosine = -cosine;
  return {angle < 0 ? -sine : sine, cosine};
}

double tan(double angle) noexcept {
  if (std::fabs(angle) < 0x1p-27) return angle;
  const SineCosine of = sineAndCosine(angle);
  return of.sine / of.cosine;
}

double atan2(double y, double x) noexcept {
  if (std::isnan(x) || std::isnan(y)) return x + y;
  double across = std::fabs(y), along = std::fabs(x);
  if (std::isinf(across) || std::isinf(along)) {
    across = std::isinf(across) ? 1 : 0;
    along = std::isinf(along) ? 1 : 0;
  }
  const bool is_steep = across > along;
  if (is_steep) std::swap(across, along);
  Sum angle = along > 0 ? arcTangent(across, along) : Sum{};
  if (is_steep) angle = Sum{kQuarterTurn, kQuarterTurnLow} + Sum{-angle.high, -angle.low};
  if (std::signbit(x))
    angle = Sum{2 * kQuarterTurn, 2 * kQuarterTurnLow} + Sum{-angle.high, -angle.low};
  return std::copysign(angle.high, y);
}

double atan(double tangent) noexcept { return atan2(tangent, 1); }

double asin(double sine) noexcept {
  if (!(std::fabs(sine) <= 1)) return kNotANumber;
  return atan2(sine, std::sqrt((1 - sine) * (1 + sine)));
}

double acos(double cosine) noexcept {
  if (!(std::fabs(cosine) <= 1)) return kNotANumber;
  return atan2(std::sqrt((1 - cosine) * (1 + cosine)), cosine);
}

}  // namespace ambient::portable
