#include "bullet_ambient/base/elementary.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

// Numbers and sums of numbers from which elementary functions are made, then functions of angles,
// then powers. Constants of those functions in hexadecimal are pi, log(2) and arc tangents, rounded
// to the digits shown. Polynomials are Taylor series, truncated where the next term is below
// rounding.

namespace ambient::portable {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// An unevaluated sum whose second term is below the rounding of the first.
struct Sum {
  double high = 0;
  double low = 0;
};

/// a + b without error (Knuth).
inline Sum exactSum(double a, double b) {
  const double sum = a + b, b_in_sum = sum - a;
  return {sum, (a - (sum - b_in_sum)) + (b - b_in_sum)};
}

/// a + b without error where |a| >= |b| (Dekker).
inline Sum exactOrderedSum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Splits a into its leading 26 bits and the remainder (Veltkamp).
inline Sum split(double a) {
  const double shifted = 0x1p27 * a + a;
  const double high = shifted - (shifted - a);
  return {high, a - high};
}

/// a b without error (Dekker), for factors between 1e-140 and 1e140.
inline Sum exactProduct(double a, double b) {
  const double product = a * b;
  const Sum x = split(a), y = split(b);
  return {product,
          x.low * y.low - (((product - x.high * y.high) - x.low * y.high) - x.high * y.low)};
}

inline Sum operator+(const Sum& a, const Sum& b) {
  const Sum sum = exactSum(a.high, b.high);
  return exactOrderedSum(sum.high, sum.low + (a.low + b.low));
}

inline Sum operator*(const Sum& a, const Sum& b) {
  const Sum product = exactProduct(a.high, b.high);
  return exactOrderedSum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

/// c_0 + c_1 x + c_2 x^2 + ...
template <int kTerms>
double polynomial(const double (&c)[kTerms], double x) {
  double sum = c[kTerms - 1];
  for (int i = kTerms - 2; i >= 0; --i) sum = c[i] + x * sum;
  return sum;
}

/// Nearest integer. @pre |x| < 2^51
inline double nearest(double x) {
  constexpr double kShift = 0x1.8p52;  // the last bit of kShift has the value 1
  return (x + kShift) - kShift;
}

inline std::uint64_t bitsOf(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

inline double withBits(std::uint64_t bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// 2^exponent, exponent in [-1022, 1023].
inline double powerOfTwo(int exponent) {
  return withBits(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

/// Exponent of the leading bit of a number that is neither subnormal nor zero.
inline int exponentOf(double x) { return static_cast<int>(bitsOf(x) >> 52 & 0x7ff) - 1023; }

/// x 2^exponent, rounded once, exponent in [-2044, 2046].
inline double scaled(double x, int exponent) {
  const int half = exponent / 2;
  return x * powerOfTwo(half) * powerOfTwo(exponent - half);
}

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

namespace {

constexpr double kLog2 = 0x1.62e42fefa2p-1, kLog2Low = 0x1.9ef35793c7673p-41;  // 40 bits; remainder

/// e^x = 2^power (1 + first + rest), |first + rest| < 0.42.
struct ReducedExponential {
  int power = 0;
  double first = 0;  ///< r = x - power log(2), rounded to double
  double rest = 0;   ///< e^r - 1 - first
};

/// Reduces e^x. @pre x.high in [-746, 710]
ReducedExponential reduceExponent(const Sum& x) {
  static constexpr double kSeries[] = {1.0 / 2,          1.0 / 6,           1.0 / 24,
                                       1.0 / 120,        1.0 / 720,         1.0 / 5040,
                                       1.0 / 40320,      1.0 / 362880,      1.0 / 3628800,
                                       1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0};
  constexpr double kLog2E = 0x1.71547652b82fep+0;
  const double power = nearest(x.high * kLog2E);
  const Sum left = exactSum(x.high - power * kLog2, x.low - power * kLog2Low);
  const double r = left.high;
  const double rest = r * r * polynomial(kSeries, r) + (left.low + left.low * r);
  return {static_cast<int>(power), r, rest};
}

/// Largest and smallest x for which e^x neither overflows nor vanishes.
constexpr double kLargestExponent = 0x1.62e42fefa39efp+9, kSmallestExponent = -745.2;

double expOf(const Sum& x) {
  if (!(x.high <= kLargestExponent)) return x.high > 0 ? kInfinity : kNotANumber;
  if (x.high < kSmallestExponent) return 0;
  const ReducedExponential e = reduceExponent(x);
  const Sum lead = exactOrderedSum(1, e.first);
  return scaled(lead.high + (lead.low + e.rest), e.power);
}

/// x = 2^power m, m in (0.7, 1.42).
struct ReducedLogarithm {
  double power = 0;
  double m = 0;
};

/// @pre x is positive and finite
ReducedLogarithm reduceLogarithm(double x) {
  double power = 0;
  if (x < 0x1p-1022) {
    x *= 0x1p54;
    power = -54;
  }
  const int exponent = exponentOf(x);
  const double m = withBits((bitsOf(x) & 0xfffffffffffff) | 0x3ff0000000000000);
  if (m > 1.4142135623730951) return {power + exponent + 1, m / 2};
  return {power + exponent, m};
}

/// Logarithm of a positive finite number, with relative error 2^-64.
Sum logOf(double x) {
  static constexpr double kSeries[] = {1.0 / 5,  1.0 / 7,  1.0 / 9,  1.0 / 11, 1.0 / 13,
                                       1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23};
  constexpr Sum kThird{0x1.5555555555555p-2, 0x1.5555555555555p-56};
  const auto [power, m] = reduceLogarithm(x);
  if (m == 1 && power == 0) return {0, 0};
  // log(m) = 2 artanh(s), s = (m - 1) / (m + 1)
  const double above = m - 1;
  const Sum below = exactSum(m, 1);
  const double s = above / below.high;
  const Sum back = exactProduct(s, below.high);
  const Sum quotient{s, ((above - back.high) - back.low - s * below.low) / below.high};
  const Sum square = quotient * quotient;
  const double tail = square.high * square.high * polynomial(kSeries, square.high);
  const Sum relative = square * kThird + Sum{tail, 0};  // artanh(s) / s - 1
  const Sum artanh = quotient + quotient * relative;
  return Sum{power * kLog2, 0} + (Sum{2 * artanh.high, 2 * artanh.low} + Sum{power * kLog2Low, 0});
}

bool isInteger(double x) { return x == std::trunc(x); }
bool isOdd(double x) { return isInteger(x) && std::fabs(x) < 0x1p53 && !isInteger(x / 2); }

/// Returns size^exponent if either is zero, infinite or NaN. @pre size >= 0
double powOfExtremes(double size, double exponent) {
  if (std::isnan(size) || std::isnan(exponent)) return size + exponent;
  if (std::isinf(exponent)) {
    if (size == 1) return 1;
    return (size > 1) == (exponent > 0) ? kInfinity : 0;
  }
  return (size > 1) == (exponent > 0) ? kInfinity : 0;
}

}  // namespace

double exp(double exponent) noexcept { return expOf({exponent, 0}); }

double expm1(double exponent) noexcept {
  if (std::fabs(exponent) < 0x1p-54) return exponent;
  if (exponent < -40) return -1;
  if (!(exponent <= kLargestExponent)) return exponent > 0 ? kInfinity : kNotANumber;
  const ReducedExponential e = reduceExponent({exponent, 0});
  if (e.power == 0) return e.first + e.rest;
  if (e.power > 60) return expOf({exponent, 0});
  const double power = powerOfTwo(e.power);
  const Sum lead = exactSum(power - 1, power * e.first);
  return lead.high + (lead.low + power * e.rest);
}

double log(double x) noexcept {
  if (!(x > 0)) return x == 0 ? -kInfinity : kNotANumber;
  if (std::isinf(x)) return x;
  // log(1 + f) = f - f^2/2 + s (f^2/2 + R), s = f / (2 + f), R = 2 s^2/3 + 2 s^4/5 + ...
  static constexpr double kSeries[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11, 2.0 / 13,
                                       2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23};
  const auto [power, m] = reduceLogarithm(x);
  const double f = m - 1, s = f / (2 + f), square = s * s, half = f * f / 2;
  const double small = s * (half + square * polynomial(kSeries, square)) + power * kLog2Low;
  return power * kLog2 - ((half - small) - f);
}

double log1p(double x) noexcept {
  if (!(x > -1)) return x == -1 ? -kInfinity : kNotANumber;
  if (std::isinf(x)) return x;
  if (std::fabs(x) < 0x1p-20) return x - x * x * (1.0 / 2 - x * (1.0 / 3 - x / 4));
  const Sum sum = exactSum(1, x);
  return (logOf(sum.high) + Sum{sum.low / sum.high, 0}).high;
}

double atanh(double x) noexcept {
  const double size = std::fabs(x);
  return std::copysign(log1p(2 * size / (1 - size)) / 2, x);
}

double pow(double base, double exponent) noexcept {
  if (exponent == 0 || base == 1) return 1;
  if (base < 0 && base > -kInfinity && !isInteger(exponent)) return kNotANumber;
  const double size = std::fabs(base);
  double power;
  if (size > 0 && size < kInfinity && std::fabs(exponent) < kInfinity) {
    const Sum logarithm = logOf(size);
    const double about = exponent * logarithm.high;
    if (std::fabs(about) > 800 || std::fabs(about) < 0x1p-60)
      power = expOf({about, 0});  // infinite, 0 or 1
    else
      power = expOf(logarithm * Sum{exponent, 0});
  } else {
    power = powOfExtremes(size, exponent);
  }
  return std::signbit(base) && isOdd(exponent) ? -power : power;
}

double cbrt(double x) noexcept {
  if (x == 0 || !(std::fabs(x) < kInfinity)) return x;
  double size = std::fabs(x);
  int power = 0;
  if (size < 0x1p-1022) {
    size *= 0x1p54;
    power = -54 / 3;
  }
  const int exponent = exponentOf(size);
  const int third = (exponent + 1200) / 3 - 400;  // rounded down
  const double m = size * powerOfTwo(-third) * powerOfTwo(-third) * powerOfTwo(-third);
  double root = 0.7321 + m * (0.2835 - 0.01563 * m);  // relative error 0.03 for m in [1, 8)
  for (int i = 0; i < 2; ++i) {                       // Halley: third order of convergence
    const double cube = root * root * root;
    root *= (cube + 2 * m) / (2 * cube + m);
  }
  const Sum square = exactProduct(root, root);
  const Sum cube = square * Sum{root, 0};
  root -= ((cube.high - m) + cube.low) / (3 * square.high);
  return std::copysign(root * powerOfTwo(third + power), x);
}

double hypot(double x, double y) noexcept { return hypot(x, y, 0); }

double hypot(double x, double y, double z) noexcept {
  const double largest = std::fmax(std::fmax(std::fabs(x), std::fabs(y)), std::fabs(z));
  if (std::isinf(x) || std::isinf(y) || std::isinf(z)) return kInfinity;
  if (std::isnan(x) || std::isnan(y) || std::isnan(z)) return kNotANumber;
  if (largest > 1e-140 && largest < 1e140) return std::sqrt(x * x + y * y + z * z);
  if (largest == 0) return 0;
  const double scale = largest < 1 ? 0x1p600 : 0x1p-600;
  x *= scale;
  y *= scale;
  z *= scale;
  return std::sqrt(x * x + y * y + z * z) / scale;
}

}  // namespace ambient::portable

double ambient::roundedToSingle(double value) noexcept {
  return static_cast<double>(static_cast<float>(value));
}
