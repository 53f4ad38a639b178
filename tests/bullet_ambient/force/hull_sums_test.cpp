#include "bullet_ambient/force/hull_sums.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/packed_hull.h"
#include "tests/support/hull_bodies.h"

namespace ambient {
namespace {

std::string bitsOf(const HullSums& sums) {
  std::string bytes(sizeof sums, '\0');
  std::memcpy(bytes.data(), &sums, sizeof sums);
  return bytes;
}

TEST(HullSums, HaveTheSameBitsWithEveryInstructionSet) {
  std::vector<SumHull> kernels;
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512})
    if (const SumHull kernel = kSumHull.of(set)) kernels.push_back(kernel);
  if (kernels.empty()) GTEST_SKIP() << "this processor has the baseline only";
  for (const int divisions : {1, 2, 3, 7, 30}) {
    const PackedHull hull(test::boxBody({2, 1.3, 0.7}, divisions));
    for (int i = -12; i <= 12; ++i) {
      const HullPlane plane{{0.48, 0.6, 0.64}, {{0.8, -0.6, 0}, {0.384, 0.512, -0.768}}, 0.1 * i};
      for (const SumHull kernel : kernels)
        EXPECT_EQ(bitsOf(kernel(hull.blocks(), plane)),
                  bitsOf(sumHullBaseline(hull.blocks(), plane)))
            << divisions << " divisions, height " << plane.height;
    }
  }
}

}  // namespace
}  // namespace ambient
