#include "bullet_ambient/force/kernels/face_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "bullet_ambient/base/fnv1a.h"
#include "tests/support/bits_of.h"

namespace ambient {
namespace {

/// Random faces made with +, *, / and the square root only: equal bits with every compiler.
class ArbitraryFaces {
 public:
  explicit ArbitraryFaces(std::size_t count) {
    for (std::vector<double>& column : columns_) column.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double x = next();
      const double y = next();
      const double z = next();
      const double length = std::sqrt(x * x + y * y + z * z);
      const double face[7] = {
          x / length, y / length, z / length, next(), next(), next(), next() * next() + 0.01};
      for (int column = 0; column < 7; ++column) columns_[column][i] = face[column];
    }
  }

  FaceColumns columns() const {
    return {{columns_[0].data(), columns_[1].data(), columns_[2].data()},
            {columns_[3].data(), columns_[4].data(), columns_[5].data()},
            columns_[6].data(),
            columns_[6].size()};
  }

 private:
  double next() {  // in (-1, 1); Knuth's MMIX generator
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(static_cast<std::int64_t>(state_) >> 11) * 0x1p-52;
  }

  std::uint64_t state_ = 1;
  std::vector<double> columns_[7];
};

FaceMotion motionFor(double cosine) {
  return {{0.75, -1.5, 0.3}, {1.25, 0.4, -2.0}, -cosine * std::abs(cosine), 1 - cosine * cosine};
}

TEST(FaceSums, HaveTheSameBitsWithEveryInstructionSet) {
  std::vector<SumFaces> kernels;
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512})
    if (const SumFaces kernel = kSumFaces.of(set)) kernels.push_back(kernel);
  if (kernels.empty()) GTEST_SKIP() << "this processor has the baseline only";
  for (const std::size_t count : {0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 255, 256, 257, 263, 1000}) {
    const ArbitraryFaces faces(count);
    for (const double cosine : {0.0, -0.3, -0.7, -1.0})
      for (const bool with_friction : {false, true})
        for (const SumFaces kernel : kernels)
          EXPECT_EQ(
              test::bitsOf(kernel(faces.columns(), motionFor(cosine), with_friction)),
              test::bitsOf(sumFacesBaseline(faces.columns(), motionFor(cosine), with_friction)))
              << count << " faces, cosine " << cosine;
  }
}

TEST(FaceSums, HaveTheBitsOfTheFirstRelease) {
  // Hashes of the library's own results. Compiler, optimisation level or processor must not change
  // them; a new order of summation may: a change of behaviour.
  const ArbitraryFaces faces(333);
  const auto hashFor = [&](double cosine) {
    const FaceSums sums = sumFacesBaseline(faces.columns(), motionFor(cosine), true);
    return fnv1a64(test::bitsOf(sums.pressure) + test::bitsOf(sums.friction));
  };
  EXPECT_EQ(hashFor(0), 15685114710678222963u);
  EXPECT_EQ(hashFor(-0.7), 4364337294997135979u);
}

TEST(FaceSums, ReadNothingBeyondTheLastFace) {
  // Columns end with the allocation: AddressSanitizer detects access to one face more.
  for (std::size_t count = 0; count < 20; ++count) {
    const ArbitraryFaces faces(count);
    const FaceSums sums = sumFacesBaseline(faces.columns(), motionFor(0), true);
    for (const double value : sums.pressure) EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(FaceSums, ExistForTheBaselineEverywhere) {
  EXPECT_EQ(kSumFaces.of(InstructionSet::kBaseline), &sumFacesBaseline);
}

}  // namespace
}  // namespace ambient
