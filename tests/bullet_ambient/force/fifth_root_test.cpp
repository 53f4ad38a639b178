#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bullet_ambient/force/law/skin_friction.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

double relativeError(double x) {
  const long double exact = std::pow(static_cast<long double>(x), -0.2L);
  return static_cast<double>(std::abs(reynoldsPower(x) / exact - 1));
}

TEST(InverseFifthRoot, IsThePowerToOneUnitInTheLastPlace) {
  test::Arbitrary arbitrary(1);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::exp2(arbitrary.between(-1022, 1023.99));
    ASSERT_LE(relativeError(x), kUlp) << x;
  }
}

TEST(InverseFifthRoot, IsAsGoodWithinEveryOctaveOfItsArgument) {
  // Five octaves are one period of the initial guess.
  for (int i = 0; i < 5 * 4096; ++i) {
    const double x = std::ldexp(1 + (i % 4096) / 4096.0, i / 4096);
    ASSERT_LE(relativeError(x), kUlp) << x;
  }
}

TEST(InverseFifthRoot, ReachesTheEndsOfTheNormalRange) {
  for (const double x :
       {std::numeric_limits<double>::min(), std::numeric_limits<double>::max(), 1.0})
    EXPECT_LE(relativeError(x), kUlp) << x;
}

TEST(InverseFifthRoot, OfZeroIsFiniteSoThatNoSlipMeansNoFriction) {
  const double r = reynoldsPower(0.0);
  EXPECT_TRUE(std::isfinite(r * r * r));
  EXPECT_EQ(0.0 * (r * r * r), 0);
}

TEST(InverseFifthRoot, OfSubnormalNumbersIsPositiveAndFinite) {
  for (const double x :
       {std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::min() / 3}) {
    EXPECT_GT(reynoldsPower(x), 0);
    EXPECT_TRUE(std::isfinite(reynoldsPower(x)));
  }
}

}  // namespace
}  // namespace ambient
