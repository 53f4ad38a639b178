#include "bullet_ambient/force/kernels/hull_sums.h"

#include <gtest/gtest.h>

#include <vector>

#include "bullet_ambient/fluid_body/packed/packed_hull.h"
#include "tests/support/bits_of.h"
#include "tests/support/bodies/hull_bodies.h"

namespace ambient {
namespace {

TEST(HullSums, HaveTheSameBitsWithEveryInstructionSet) {
  std::vector<const HullKernel*> kernels;
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512})
    if (const HullKernel* kernel = kHullKernels.of(set)) kernels.push_back(kernel);
  if (kernels.empty()) GTEST_SKIP() << "this processor has the baseline only";
  const HullKernel& baseline = kHullKernelBaseline;
  for (const int level : {0, 1, 2, 4}) {
    const PackedHull hull(test::hullBody(test::geodesicEllipsoid({2, 1.3, 0.7}, level)));
    for (int i = -12; i <= 12; ++i) {
      const HullPlane plane{{0.48, 0.6, 0.64}, {{0.8, -0.6, 0}, {0.384, 0.512, -0.768}}, 0.1 * i};
      for (const HullKernel* kernel : kernels) {
        EXPECT_EQ(test::bitsOf(kernel->sums(hull.blocks(), plane)),
                  test::bitsOf(baseline.sums(hull.blocks(), plane)))
            << "level " << level << ", height " << plane.height;
        EXPECT_EQ(test::bitsOf(kernel->extent(hull.corners(), plane.normal)),
                  test::bitsOf(baseline.extent(hull.corners(), plane.normal)));
      }
    }
  }
}

}  // namespace
}  // namespace ambient
