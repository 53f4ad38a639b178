#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/fnv1a.h"
#include "preprocess/base/output_file.h"
#include "tests/support/temporary_folder.h"

namespace ambient {
namespace {

#if defined(NDEBUG)
TEST(AmbientAssert, EvaluatesNothingInRelease) {
  int calls = 0;
  AMBIENT_ASSERT(++calls < 0);
  EXPECT_EQ(calls, 0);
}
#else
TEST(AmbientAssertDeathTest, NamesWhatDidNotHoldAndWhere) {
  const int lanes = 9;
  AMBIENT_ASSERT(lanes > 8);
  EXPECT_DEATH(AMBIENT_ASSERT(lanes <= 8), "base_test.cpp:[0-9]+: this must hold: lanes <= 8");
}
#endif

// Test vectors of Noll's reference page and draft-eastlake-fnv.
TEST(Fnv1a, HasTheValuesOfItsTestVectors) {
  EXPECT_EQ(fnv1a64(""), 0xcbf29ce484222325u);
  EXPECT_EQ(fnv1a64("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(fnv1a64("foobar"), 0x85944171f73967e8u);
}

TEST(Fnv1a, CountsBytesAboveSevenBitsAsUnsigned) {
  EXPECT_EQ(fnv1a64("\xff"), (0xcbf29ce484222325u ^ 0xffu) * 0x100000001b3u);
}

TEST(Fnv1a, IsKnownAtCompileTime) { static_assert(fnv1a64("a") == 0xaf63dc4c8601ec8cu); }

TEST(OutputFile, HasItsNameOnlyAfterCommit) {
  const TemporaryFolder folder;
  const auto file = folder / "a.txt";
  {
    OutputFile output(file);
    output.write("text");
    EXPECT_FALSE(std::filesystem::exists(file));
    output.commit();
  }
  EXPECT_EQ(readText(file), "text");
}

TEST(OutputFile, LeavesNothingWithoutCommitAndKeepsTheOldFile) {
  const TemporaryFolder folder;
  const auto file = folder / "a.txt";
  std::ofstream(file) << "old";
  { OutputFile(file).write("new"); }
  EXPECT_EQ(readText(file), "old");
  std::filesystem::remove(file);
  EXPECT_TRUE(folder.empty());
}

TEST(OutputFile, NamesAFileThatCannotBeWritten) {
  EXPECT_THROW(OutputFile("no/such/folder/a.txt"), std::runtime_error);
}

TEST(SinglePrecision, IsWhatFilesHold) {
  EXPECT_EQ(roundedToSingle(0.1), 13421773.0 / 134217728);  // 24 bits
  EXPECT_EQ(roundedToSingle(1 + 0x1p-24), 1);
  EXPECT_EQ(roundedToSingle(-0.5), -0.5);
}

// References: the C library's functions of long double. Their relative error is some 2^-63, a
// thousandth of the tolerances.

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

using Function = std::function<double(double)>;
using Reference = std::function<long double(long double)>;

struct Range {
  double low, high;
  bool is_of_exponents = false;  // exponents of 2: arguments of both signs if `low` is negative
};

double unitInLastPlace(double value) {
  const double size = std::fabs(value);
  return std::nextafter(size, kInfinity) - size;
}

// Largest error over 20 000 random arguments, in units in the last place.
double worstError(const Function& function, const Reference& reference, const Range& range) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> position(range.low, range.high);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    double x = position(engine);
    if (range.is_of_exponents) x = std::exp2(x);
    const long double expected = reference(x);
    const double value = function(x), rounded = static_cast<double>(expected);
    if (value == rounded) continue;
    const long double unit = unitInLastPlace(rounded);
    worst = std::max(worst, static_cast<double>(std::fabs((value - expected) / unit)));
    if (std::isnan(value)) return kInfinity;
  }
  return worst;
}

TEST(Elementary, SineAndCosine) {
  for (const Range& range : {Range{-0.785, 0.785}, {-10, 10}, {-1e6, 1e6}, {-60, 1023, true}}) {
    EXPECT_LT(worstError(portable::sin, sinl, range), 0.8) << range.high;
    EXPECT_LT(worstError(portable::cos, cosl, range), 0.8) << range.high;
    EXPECT_LT(worstError(portable::tan, tanl, range), 2.2) << range.high;
  }
  // Doubles nearest to multiples of pi / 2: Muller, Elementary Functions (2016), table 11.1, quoted
  // from memory. Tests of the last bits do not need these values.
  for (const double x : {6381956970095103.0 * 0x1p797, 0x1.921fb54442d18p0, 3.14159265358979312}) {
    EXPECT_NEAR(portable::cos(x), static_cast<double>(cosl(x)), unitInLastPlace(std::cos(x)));
    EXPECT_NEAR(portable::sin(x), static_cast<double>(sinl(x)), unitInLastPlace(std::sin(x)));
  }
}

TEST(Elementary, SineAndCosineTogetherHaveTheBitsOfEach) {
  std::mt19937_64 engine(5);
  for (const double size : {1e-9, 1e-3, 1.0, 10.0, 1e3, 1e7, 1e300}) {
    std::uniform_real_distribution<double> angles(-size, size);
    for (int i = 0; i < 1000; ++i) {
      const double angle = angles(engine);
      const portable::SineCosine both = portable::sineAndCosine(angle);
      EXPECT_EQ(both.sine, portable::sin(angle)) << angle;
      EXPECT_EQ(both.cosine, portable::cos(angle)) << angle;
    }
  }
}

TEST(Elementary, InverseTrigonometricFunctions) {
  for (const Range& range : {Range{-1, 1}, {-60, -1e-3, true}}) {
    EXPECT_LT(worstError(portable::asin, asinl, range), 1.8) << range.low;
    EXPECT_LT(worstError(portable::acos, acosl, range), 1.6) << range.low;
  }
  for (const Range& range : {Range{-2, 2}, {-300, 300, true}}) {
    EXPECT_LT(worstError(portable::atan, atanl, range), 0.6) << range.low;
    for (const double other : {-3.0, 1e-5, 1e100}) {
      const auto asY = [&](auto x) { return portable::atan2(x, other); };
      const auto asX = [&](auto x) { return portable::atan2(other, x); };
      EXPECT_LT(worstError(
                    asY, [&](long double x) { return atan2l(x, other); }, range),
                0.6);
      EXPECT_LT(worstError(
                    asX, [&](long double x) { return atan2l(other, x); }, range),
                0.6);
    }
  }
}

TEST(Elementary, ExponentialFunctionsAndLogarithms) {
  for (const Range& range : {Range{-1, 1}, {-700, 700}, {-60, 9, true}}) {
    EXPECT_LT(worstError(portable::exp, expl, range), 0.7) << range.low;
    EXPECT_LT(worstError(portable::expm1, expm1l, range), 1.1) << range.low;
  }
  for (const Range& range : {Range{0.5, 2}, {-1074, 1023, true}})
    EXPECT_LT(worstError(portable::log, logl, range), 0.9) << range.low;
  for (const Range& range : {Range{-0.9, 2}, {-300, 300, true}})
    EXPECT_LT(worstError(portable::log1p, log1pl, range), 0.6) << range.low;
  for (const Range& range : {Range{-0.99, 0.99}, {-60, -0.01, true}})
    EXPECT_LT(worstError(portable::atanh, atanhl, range), 2.6) << range.low;
}

TEST(Elementary, PowersAndRoots) {
  for (const double exponent : {0.7, -2.6, 30.7, 1.0 / 3, -0.25, 100.0}) {
    const auto power = [&](double x) { return portable::pow(x, exponent); };
    const auto expected = [&](long double x) { return powl(x, exponent); };
    EXPECT_LT(worstError(power, expected, {-9, 9, true}), 0.7) << exponent;
  }
  const auto steep = [](double x) { return portable::pow(x, 3e5); };
  EXPECT_LT(worstError(steep, [](long double x) { return powl(x, 3e5L); }, {0.998, 1.002}), 0.7);
  for (const Range& range : {Range{-100, 100}, {-1074, 1023, true}})
    EXPECT_LT(worstError(portable::cbrt, cbrtl, range), 0.6) << range.low;
  const auto beside = [](double x) { return portable::hypot(x, 0.7 * x); };
  const auto expected = [](long double x) { return hypotl(x, 0.7 * static_cast<double>(x)); };
  for (const Range& range : {Range{-9, 9}, {-1000, 1000, true}}) {
    EXPECT_LT(worstError(beside, expected, range), 1.2) << range.low;
    const auto three = [](double x) { return portable::hypot(x, 2 * x, -x); };
    const auto reference = [](long double x) { return std::fabs(x) * std::sqrt(6.0L); };
    EXPECT_LT(worstError(three, reference, range), 1.6) << range.low;
  }
}

TEST(Elementary, ValuesThatAreExact) {
  EXPECT_EQ(portable::sin(0.0), 0);
  EXPECT_TRUE(std::signbit(portable::sin(-0.0)));
  EXPECT_EQ(portable::cos(0.0), 1);
  EXPECT_EQ(portable::exp(0.0), 1);
  EXPECT_EQ(portable::log(1.0), 0);
  EXPECT_EQ(portable::pow(10, 2), 100);
  EXPECT_EQ(portable::pow(2, -1074), kTiny);
  EXPECT_EQ(portable::pow(-2, 3), -8);
  EXPECT_EQ(portable::pow(-2, 4), 16);
  EXPECT_EQ(portable::cbrt(-27.0), -3);
  EXPECT_EQ(portable::hypot(3, 4), 5);
  EXPECT_EQ(portable::acos(1.0), 0);
  for (const double y : {0.0, -0.0, 2.0, -2.0, kInfinity, -kInfinity})
    for (const double x : {0.0, -0.0, 2.0, -2.0, kInfinity, -kInfinity})
      EXPECT_EQ(portable::atan2(y, x), std::atan2(y, x)) << y << " " << x;
}

TEST(Elementary, ExtremeArgumentsGiveWhatTheCLibraryGives) {
  struct Pair {
    Function function, reference;
  };
  const auto of = [](double (*f)(double), double (*g)(double)) { return Pair{f, g}; };
  for (const auto& [function, reference] :
       {of(portable::sin, std::sin), of(portable::cos, std::cos), of(portable::tan, std::tan),
        of(portable::asin, std::asin), of(portable::acos, std::acos), of(portable::atan, std::atan),
        of(portable::exp, std::exp), of(portable::expm1, std::expm1), of(portable::log, std::log),
        of(portable::log1p, std::log1p), of(portable::cbrt, std::cbrt)})
    for (const double x : {kInfinity, -kInfinity, kNotANumber, 0.0, -0.0, kTiny, -kTiny, 1e-310,
                           -2.0, 1.5, 709.9, -745.2, -800.0, 1e300}) {
      const double value = function(x), expected = reference(x);
      if (std::isnan(expected))
        EXPECT_TRUE(std::isnan(value)) << x;
      else if (std::isinf(expected) || expected == 0)
        EXPECT_EQ(value, expected) << x;
      else
        EXPECT_NEAR(value, expected, 3 * unitInLastPlace(expected)) << x;
    }
  for (const double base : {0.0, -0.0, 1.0, 0.5, 2.0, -2.0, kInfinity, -kInfinity, kNotANumber})
    for (const double exponent : {0.0, 0.5, -3.0, 3.0, 2.0, 1e300, kInfinity, -kInfinity}) {
      const double value = portable::pow(base, exponent), expected = std::pow(base, exponent);
      if (std::isnan(expected))
        EXPECT_TRUE(std::isnan(value)) << base << "^" << exponent;
      else
        EXPECT_EQ(value, expected) << base << "^" << exponent;
    }
  EXPECT_TRUE(std::isnan(portable::atan2(kNotANumber, 1)));
  EXPECT_EQ(portable::hypot(kInfinity, kNotANumber), kInfinity);
  EXPECT_EQ(portable::hypot(0, 0), 0);
}

// Expects fixed bits with any compiler, processor and variant of the C library.
TEST(Elementary, HasTheSameBitsEverywhere) {
  std::mt19937_64 engine(7);
  std::uint64_t hash = 0;
  const auto add = [&hash](double value) {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15;
    hash ^= hash >> 29;
  };
  for (int i = 0; i < 20000; ++i) {
    const double share = static_cast<double>(engine() >> 11) * 0x1p-53, x = 40 * share - 20;
    for (const double value :
         {portable::sin(x), portable::cos(x), portable::tan(x), portable::asin(share),
          portable::acos(share), portable::atan(x), portable::atan2(share, x), portable::exp(x),
          portable::expm1(x), portable::log(share + 0.1), portable::log1p(share),
          portable::atanh(share), portable::pow(share, x), portable::cbrt(x),
          portable::hypot(x, share), portable::sin(1e9 * x)})
      add(value);
  }
  EXPECT_EQ(hash, 0xdec0204467fc7097) << std::hex << hash;
}

}  // namespace
}  // namespace ambient
