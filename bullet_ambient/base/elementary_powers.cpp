#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/elementary_numbers.h"

namespace ambient::portable {
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
  constexpr double kPerLog2 = 0x1.71547652b82fep+0;
  const double power = nearest(x.high * kPerLog2);
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
