#include "bullet_ambient/motion/motion_series.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "bullet_ambient/motion/kirchhoff_flow.h"
#include "tests/support/free_body.h"
#include "tests/support/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::flowWithoutLoads;
using test::FreeBody;

FreeBody movingBody(unsigned seed) {
  Arbitrary arbitrary(seed);
  FreeBody body({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
  body.state.twist = arbitrary.twist(10, 3);
  return body;
}

// Points into the body.
SeriesStart startOf(const FreeBody& body, double duration) {
  SeriesStart start;
  start.inverse_inertia = body.model().inverse_inertia.data();
  start.has_diagonal_inertia = body.model().has_diagonal_inertia;
  Eigen::Map<Vector6>(start.momentum) = body.model().inertia * body.state.twist.vector();
  Eigen::Map<Vector6>(start.twist) = body.state.twist.vector();
  start.duration = duration;
  start.precision = kToRounding;
  return start;
}

TEST(MotionSeries, HasTheSameBitsWithEveryInstructionSet) {
#if defined(__x86_64__)
  if (!hasAvx2MotionSeries()) GTEST_SKIP() << "this processor has no AVX2";
  for (unsigned seed = 0; seed < 200; ++seed) {
    for (const double duration : {1e-3, 1.0 / 60, 3.0}) {
      const FreeBody body = movingBody(seed);
      const SeriesStart start = startOf(body, duration);
      const SeriesEnd baseline = sumMotionSeriesBaseline(start);
      const SeriesEnd avx2 = sumMotionSeriesAvx2(start);
      EXPECT_EQ(std::memcmp(&baseline, &avx2, sizeof baseline), 0) << seed << " over " << duration;
    }
  }
#endif
}

TEST(MotionSeries, CoversTheWholeOfAShortDurationAndAPartOfALongOne) {
  const FreeBody body = movingBody(1);
  EXPECT_EQ(sumMotionSeriesBaseline(startOf(body, 1e-3)).fraction, 1);
  const double part = sumMotionSeriesBaseline(startOf(body, 10)).fraction;
  EXPECT_GT(part, 0);
  EXPECT_LT(part, 0.5);
}

TEST(FlowWithoutLoads, IsAsPreciseAsAskedAndNeverGainsEnergy) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    for (const double precision : {1e-6, 1e-9, 1e-12}) {
      FreeBody body = movingBody(seed);
      const double before = body.kineticEnergy();
      const RigidState exact = flowWithoutLoads(body, 0.02).state;
      body.state = flowWithoutLoads(body, 0.02, precision).state;
      const Vector6 error = body.state.twist.vector() - exact.twist.vector();
      EXPECT_LT(std::sqrt(inertiaNormSquared(body.model(), error) / (2 * before)), precision)
          << seed;
      EXPECT_LT(test::angleBetween(body.state.orientation, exact.orientation), precision) << seed;
      // Up to the rounding of the scaling: each component, and the factor.
      EXPECT_LE(body.kineticEnergy(), before * (1 + 1e-15)) << seed;
    }
  }
}

}  // namespace
}  // namespace ambient
