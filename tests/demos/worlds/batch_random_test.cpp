#include "demos/worlds/batch_random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace ambient {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

// The first and the last from Random123's known answers; the others by numpy.random.Philox of NumPy
// 1.24, which adds 1 to its counter before it draws.
TEST(Philox, GivesTheKnownNumbers) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (RandomBlock{0x16554d9eca36314c, 0xdb20fe9d672d0fdc,
                                                       0xd7e772cee186176b, 0x7e68b68aec7ba23b}));
  EXPECT_EQ(philox({5, 2, 3, 9}, {77, 0}), (RandomBlock{0xc6bfedc7945cad01, 0xcb01ec7361cbc1cf,
                                                        0x4c030d8debb7e438, 0x4761429bb19cc8f4}));
  EXPECT_EQ(philox({kAll, kAll, kAll, kAll}, {kAll, kAll}),
            (RandomBlock{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6,
                         0xa09caebf594f0ba0}));
}

TEST(RandomNumbers, AreFunctionsOfTheirPlace) {
  RandomNumbers numbers({77, RandomStream::kNoise, 3, 9}), again({77, RandomStream::kNoise, 3, 9});
  const RandomBlock first = philox({0, 2, 3, 9}, {77, 0}), second = philox({1, 2, 3, 9}, {77, 0});
  for (int k = 0; k < 6; ++k) {
    const std::uint64_t bits =
        k < 4 ? first[static_cast<std::size_t>(k)] : second[static_cast<std::size_t>(k - 4)];
    const double expected = std::ldexp(static_cast<double>(bits >> 11), -53);
    EXPECT_EQ(numbers.uniform(), expected);
    EXPECT_EQ(again.uniform(), expected);
  }
}

// Mean, variance and fourth moment of 20000 normal numbers, within 4 standard deviations of each.
TEST(RandomNumbers, OfANormalDistribution) {
  constexpr int kCount = 20000;
  RandomNumbers numbers({5, RandomStream::kGust, 0, 0});
  double mean = 0, square = 0, fourth = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = numbers.normal();
    mean += x / kCount;
    square += x * x / kCount;
    fourth += x * x * x * x / kCount;
  }
  const double sigma = 4 / std::sqrt(kCount);
  EXPECT_NEAR(mean, 0, sigma);
  EXPECT_NEAR(square, 1, sigma * std::sqrt(2));
  EXPECT_NEAR(fourth, 3, sigma * std::sqrt(96));
}

}  // namespace
}  // namespace ambient
