#include <gtest/gtest.h>

#include "demos/integrators/integrators.h"
#include "tests/bullet_ambient/motion/loaded_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/rotations.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::exactEnd;
using test::FreeBody;
using test::glidingDisc;
using test::kDuration;
using test::MakeBody;
using test::tumblingEllipsoid;

constexpr int kFlightSteps = 24;  // at 60 Hz

FlightSettings accurate(double tolerance, int max_substeps = 0) {
  return {tolerance, max_substeps, flyDormandPrince};
}

FreeBody fliesWith(MakeBody make, const FlightSettings& settings) {
  FreeBody body = make(settings);
  body.advance(kDuration / kFlightSteps, kFlightSteps);
  return body;
}

double distance(const RigidState& a, const RigidState& b) {
  return (a.position - b.position).norm();
}

TEST(DormandPrince, ErrorFollowsTheToleranceWhereTheLoadsAreSmooth) {
  const RigidState exact = exactEnd(glidingDisc, 8000);
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    const FreeBody disc = fliesWith(glidingDisc, accurate(tolerance));
    // 24 steps; unstable glide amplifies errors fivefold. The disc's length is 0.24 m.
    constexpr double kGrowth = 24 * 5;
    EXPECT_LT(distance(disc.state, exact), kGrowth * tolerance * 0.24) << tolerance;
    EXPECT_LT(angleBetween(disc.state.orientation, exact.orientation), kGrowth * tolerance);
  }
}

TEST(DormandPrince, WorkGrowsWithTheFifthRootOfTheTolerance) {
  // One long step: steps of the world would cut substeps and hide the order.
  const auto work = [](double tolerance) {
    FreeBody disc = glidingDisc(accurate(tolerance));
    disc.advance(kDuration);
    return static_cast<double>(disc.count.load_evaluations);
  };
  EXPECT_NEAR(std::log10(work(1e-11) / work(1e-6)), 1, 0.2);
}

TEST(DormandPrince, AgreesWithTheLeapfrogWhoseFlowIsExactWithoutLoads) {
  Arbitrary arbitrary(4);
  for (int i = 0; i < 20; ++i) {
    FreeBody body({test::shapeWithoutFaces(arbitrary.positiveDefinite())});
    body.state.twist = arbitrary.twist(4, 2);
    FreeBody other = body;
    body.settings = accurate(1e-11);
    body.advance(1.0 / 30, 30);
    other.advance(1.0 / 30, 30);
    EXPECT_LT(distance(body.state, other.state), 1e-7 * (1 + body.state.position.norm()));
  }
}

TEST(DormandPrince, HandsOverToTheLeapfrogWhenItsAttemptsAreSpent) {
  // A light plate at 300 m/s: explicit steps of this length are unstable.
  FreeBody plate = tumblingEllipsoid(accurate(1e-8, 5));
  plate.state.twist = {{100, 50, 20}, {300, 0, 300}};
  plate.setGravity(Vector3::Zero());
  double energy = plate.kineticEnergy();
  for (int i = 0; i < 60; ++i) {
    const FlightResult result =
        fly({plate.model(), plate.surroundings, plate.settings, 1.0 / 60}, plate.state, {});
    if (i == 0) {
      EXPECT_TRUE(result.count.coarse);
    }
    plate.state = result.state;
    ASSERT_TRUE(plate.state.isFinite());
    EXPECT_LE(plate.kineticEnergy(), energy * (1 + 1e-6));
    energy = plate.kineticEnergy();
  }
}

TEST(DormandPrince, ANumberThatIsNotFiniteEndsTheStep) {
  FreeBody plate = tumblingEllipsoid(accurate(1e-6));
  plate.state.twist.linear.x() = std::numeric_limits<double>::quiet_NaN();
  plate.advance(1.0 / 60);
  EXPECT_FALSE(plate.state.isFinite());
}

}  // namespace
}  // namespace ambient
