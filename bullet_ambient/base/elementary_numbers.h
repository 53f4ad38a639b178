#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

// Numbers and sums of numbers from which elementary functions are made.
// Constants of those functions in hexadecimal are pi, log(2) and arc tangents, rounded to the
// digits shown. Polynomials are Taylor series, truncated where the next term is below rounding.

namespace ambient::portable {

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

}  // namespace ambient::portable
